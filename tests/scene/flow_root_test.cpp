#include "scene/flow_root.h"

#include <gtest/gtest.h>

namespace cathlab {
namespace {

// A trunk along z with two branches; nodes 0-1-2-3, 3-4-5 and 3-6-7.  Ends: 0 (radius 6), 5 (3), 7 (9).
AnatomyModel fork() {
    AnatomyModel m;
    const auto node = [&](double x, double z, double radius) {
        m.centreline.nodes.push_back({Vec3(x, 0.0, z), radius, 0});
    };
    node(0, 0, 6), node(0, 4, 6), node(0, 8, 6), node(0, 12, 6);
    node(-3, 15, 3), node(-6, 18, 3), node(3, 15, 9), node(6, 18, 9);
    m.centreline.edges = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {3, 6}, {6, 7}};
    m.landmarks = {{"left_end", Pose{Vec3(-6, 0, 18)}, 3.0, 5}, {"middle", Pose{Vec3(0, 0, 8)}, 6.0, 2}};
    m.entries = {{"groin", Pose{Vec3(0, 0, 8)}, 6.0, 2}};  // looks along +z, 8 mm inside the trunk's end
    return m;
}

SceneContrast root(const std::string& name) {
    SceneContrast out;
    out.root.name = name;
    out.where = {"mine.toml", 9, "[contrast]"};
    return out;
}

TEST(FlowRoot, IsTheAnnulusOrElseTheWidestEndUnlessTheSceneSaysOtherwise) {
    AnatomyModel m = fork();
    EXPECT_EQ(flow_root(m, SceneContrast{}), 7);
    m.centreline.nodes[7].radius = 0.5;
    m.centreline.nodes[3].radius = 9.0;
    EXPECT_EQ(flow_root(m, SceneContrast{}), 7) << "the vessel counts, not what is left of it at its cap";
    m.annulus = Annulus{Pose{Vec3(-6, 0, 19)}, 3.0};
    EXPECT_EQ(flow_root(m, SceneContrast{}), 5);
    EXPECT_EQ(flow_root(m, root("annulus")), 5);
}

TEST(FlowRoot, IsTheEndThatTheSceneNames) {
    AnatomyModel m = fork();
    EXPECT_EQ(flow_root(m, root("left_end")), 5);
    EXPECT_EQ(flow_root(m, root("groin")), 0) << "the end behind the sheath, not the node at its mouth";
    m.entries.front().node = 0;
    EXPECT_EQ(flow_root(m, root("groin")), 0);
    SceneContrast point;
    point.root = {"", Vec3(-9, 0, 10)};
    EXPECT_EQ(flow_root(m, point), 5) << "nearest of the ends, though the trunk is nearer";
}

TEST(FlowRoot, AnUnknownNameIsAnsweredWithTheEnds) {
    for (const auto& [name, want] :
         {std::pair{"left_and", "it has auto, left_end, groin; did you mean 'left_end'?"},
          std::pair{"middle", "no end 'middle'"}, std::pair{"annulus", "it has auto, left_end, groin"}}) {
        try {
            flow_root(fork(), root(name));
            ADD_FAILURE() << name;
        } catch (const UserError& e) {
            EXPECT_NE(std::string(e.what()).find("mine.toml:9: [contrast]: root: "), std::string::npos) << e.what();
            EXPECT_NE(std::string(e.what()).find(want), std::string::npos) << e.what();
        }
    }
}

}  // namespace
}  // namespace cathlab
