#include "world/world.h"

#include <gtest/gtest.h>

#include <stdexcept>

using namespace cathlab;

namespace {

struct Thing {
    double x = 1.0;
};
void visit(Archive& archive, Thing& t) {
    archive.field("x", t.x);
}

struct Other {
    std::vector<double> y{1.0, 2.0};
};
void visit(Archive& archive, Other& o) {
    archive.field("y", o.y);
}

struct Model {  // not visitable: const after load
    double unseen = 3.0;
};

World make() {
    World world(7);
    const Entity wire = world.create("wire");
    const Entity wall = world.create("wall");
    world.add(wire, Thing{2.0});
    world.add(wall, Thing{3.0});
    world.add(wall, Other{});
    world.add(wall, Model{});
    return world;
}

}  // namespace

TEST(World, FindsEntitiesAndComponentsByNameAndType) {
    World world = make();
    EXPECT_EQ(world.entity_count(), 2U);
    EXPECT_EQ(world.name(*world.find("wall")), "wall");
    EXPECT_FALSE(world.find("heart").has_value());
    EXPECT_EQ(world.get<Thing>(*world.find("wall"))->x, 3.0);
    EXPECT_EQ(world.get<Other>(*world.find("wire")), nullptr);
    EXPECT_EQ(world.first<Thing>()->x, 2.0);
    EXPECT_EQ(world.owner<Other>(), *world.find("wall"));
    const World& seen = world;
    EXPECT_EQ(seen.get<Thing>(*seen.find("wire"))->x, 2.0);
    EXPECT_EQ(seen.first<int>(), nullptr);
    EXPECT_EQ(seen.owner<int>(), Entity::none);
    double sum = 0.0;
    world.each<Thing>([&](Entity, Thing& t) { sum += t.x; });
    EXPECT_EQ(sum, 5.0);
}

TEST(World, ANameAndAComponentStandOnce) {
    World world = make();
    EXPECT_THROW(world.create("wire"), std::logic_error);
    EXPECT_THROW(world.add(*world.find("wire"), Thing{}), std::logic_error);
}

TEST(World, ReferencesStayValidWhenTheWorldGrows) {
    World world;
    Thing& first = world.add(world.create("thing"), Thing{1.5});
    for (int i = 0; i < 1000; ++i) world.add(world.create("thing " + std::to_string(i)), Thing{});
    EXPECT_EQ(&first, world.first<Thing>());
    EXPECT_EQ(first.x, 1.5);
}

TEST(World, TheHashNamesTheEntityThatChanged) {
    World a = make();
    World b = make();
    EXPECT_EQ(a.state_hash().whole, b.state_hash().whole);
    b.get<Other>(*b.find("wall"))->y[1] = 2.5;
    const auto before = a.state_hash();
    const auto after = b.state_hash();
    EXPECT_NE(before.whole, after.whole);
    ASSERT_EQ(after.entities.size(), 2U);
    EXPECT_EQ(after.entities[0].first, "wire");
    EXPECT_EQ(before.entities[0].second, after.entities[0].second);
    EXPECT_EQ(after.entities[1].first, "wall");
    EXPECT_NE(before.entities[1].second, after.entities[1].second);
}

TEST(World, ModelsAreNotHashedAndTheStepIs) {
    World a = make();
    const std::uint64_t before = a.state_hash().whole;
    a.first<Model>()->unseen = 99.0;
    EXPECT_EQ(a.state_hash().whole, before);
    a.step_index = 1;
    EXPECT_NE(a.state_hash().whole, before);
}

TEST(World, TheHashDoesNotDependOnWhoLookedBefore) {
    World a = make();
    World b = make();
    static_cast<void>(b.first<Other>());
    static_cast<void>(b.get<int>(*b.find("wire")));
    EXPECT_EQ(a.state_hash().whole, b.state_hash().whole);
}

TEST(World, AskingForAComponentBeforeItExistsDoesNotChangeTheHash) {
    const auto build = [](bool look_first) {
        World world;
        const Entity e = world.create("e");
        if (look_first) static_cast<void>(world.get<Other>(e));
        world.add(e, Thing{});
        world.add(e, Other{});
        return world.state_hash().whole;
    };
    EXPECT_EQ(build(false), build(true));
}

TEST(World, MovesWithItsContents) {
    World a = make();
    const auto before = a.state_hash().whole;
    World b = std::move(a);
    EXPECT_EQ(b.state_hash().whole, before);
    EXPECT_EQ(b.seed(), 7U);
}
