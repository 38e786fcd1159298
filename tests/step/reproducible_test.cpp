// The same inputs give the same bits: twice, on any number of threads, alone or among other worlds.
#include <array>
#include <cstdio>

#include "core/hash.h"
#include "scene/temporary_folder.h"
#include "step/rig.h"

namespace cathlab {
namespace {

// THE EXPECTED STATE HASHES, after 150 steps of busy_hands().  They change with the physics of any room below the step,
// and with nothing else: not with the machine, its vector extensions, the threads or the build type.  A test that fails
// here prints the hash that it found.
struct ExpectedHash {
    const char* scene;
    std::uint64_t hash;
};
constexpr std::array<ExpectedHash, 3> expected_hashes{{
    {"tube_wire", 0x464f5bc39f07cd1c},
    {"tube_catheter", 0x14361b6fd89a0d2f},
    {"fork", 0x6002b14a98cf81ed},
}};

constexpr int steps = 150;

std::uint64_t hash_after(RigRun& run, int count = steps) {
    for (int k = 0; k < count; ++k) run.step(busy_hands(k));
    EXPECT_TRUE(run.finite());
    return run.hash();
}

class Rigs : public testing::TestWithParam<ExpectedHash> {};

TEST_P(Rigs, EndInTheExpectedState) {
    RigRun run(GetParam().scene);
    const std::uint64_t found = hash_after(run);
    EXPECT_EQ(found, GetParam().hash) << GetParam().scene << ": found 0x" << hash_text(found);
}

TEST_P(Rigs, EndInTheSameStateOnOneTwoAndThreeThreadsAndAgain) {
    RigRun one(GetParam().scene);
    const std::uint64_t wanted = hash_after(one);
    for (const int threads : {1, 2, 3}) {
        RigRun other(GetParam().scene, threads);
        EXPECT_EQ(hash_after(other), wanted) << threads << " threads";
    }
}

INSTANTIATE_TEST_SUITE_P(AllThree, Rigs, testing::ValuesIn(expected_hashes),
                         [](const auto& each) { return std::string(each.param.scene); });

TEST(Models, BuiltOnThreeThreadsGiveTheSameWorld) {
    const SceneSpec spec = rig_spec("fork");
    BuildOptions options;
    options.threads = 3;
    RigRun built(build_world(spec, *build_models(spec, options), spec.seed, 3));
    RigRun usual("fork");
    EXPECT_EQ(built.hash(), usual.hash());
    EXPECT_EQ(hash_after(built, 20), hash_after(usual, 20));
}

TEST(ElasticWall, EndsInTheSameStateOnAnyNumberOfThreads) {
    SceneSpec spec = rig_spec("fork");
    spec.wall.form = "elastic";
    enable(spec, "stiffening", {{"fibre_kpa", 50.0}});
    const auto models = build_models(spec, {});
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 3}) {
        RigRun run(build_world(spec, *models, spec.seed, threads));
        hashes.push_back(hash_after(run, 60));
        EXPECT_LT(run.channels.wire_penetration_mm, 0.5);
        EXPECT_EQ(run.channels.outside_count, 0.0);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(Replay, FromStepZeroMeetsEveryHash) {
    RigRun first("fork");
    std::vector<std::uint64_t> hashes{first.hash()};
    for (int k = 0; k < 40; ++k) {
        first.step(busy_hands(k));
        hashes.push_back(first.hash());
        EXPECT_NE(hashes[hashes.size() - 2], hashes.back()) << "a step leaves a trace";
    }
    RigRun again("fork");
    EXPECT_EQ(again.hash(), hashes[0]);
    for (int k = 0; k < 40; ++k) {
        again.step(busy_hands(k));
        ASSERT_EQ(again.hash(), hashes[static_cast<std::size_t>(k) + 1]) << "step " << k;
    }
}

TEST(Replay, ASeedThatNoEffectUsesChangesNothing) {
    SceneSpec spec = rig_spec("fork");
    RigRun one(spec, "fork");
    spec.seed = 987654321;
    RigRun other(spec, "fork");
    EXPECT_EQ(hash_after(one, 40), hash_after(other, 40));
}

TEST(Worlds, SteppedInTurnsDoNotKnowOfEachOther) {
    RigRun alone("fork");
    const std::uint64_t wanted = hash_after(alone, 40);
    RigRun a("fork");
    RigRun b("fork");
    RigRun tube("tube_wire");
    for (int k = 0; k < 40; ++k) {
        a.step(busy_hands(k));
        b.step(push(-20.0, 0.0));
        tube.step(busy_hands(k));
    }
    EXPECT_EQ(a.hash(), wanted);
    EXPECT_NE(b.hash(), wanted);
}

TEST(Effects, SwitchedOffAreBitIdenticalToEffectsThatNobodyNamed) {
    const TemporaryFolder folder;
    std::string overlay;
    for (const EffectInfo& info : effect_table())
        overlay += "[effects." + std::string(info.name) + "]\nenabled = false\n";
    RigRun unnamed("tube_wire");
    RigRun off(rig_spec("tube_wire", {folder.write("off.toml", overlay)}), "tube_wire");
    EXPECT_EQ(unnamed.hash(), off.hash());
    EXPECT_EQ(hash_after(unnamed, 60), hash_after(off, 60));
}

}  // namespace
}  // namespace cathlab
