// Where the wall was pressed: regions and the unrolled aorta add up to what the channels say.
#include "task/force_map.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/channels.h"
#include "core/csv.h"
#include "core/errors.h"
#include "core/input.h"
#include "core/units.h"
#include "scene/build_world.h"
#include "scene/load_scene.h"
#include "step/step.h"

namespace cathlab {
namespace {

double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(ForceMap, RegionsHoldTheWholeImpulseAndTheUnrolledWayWhatLiesOnIt) {
    const std::string root = CATHLAB_SOURCE_DIR;
    BuildOptions options;
    options.cache_folder = testing::TempDir() + "cathlab_cache";
    const auto world = build_world(load_scene(root + "/scenes/tasks/a.toml", {}, root), options);
    ForceMap map(*world);
    Channels channels;
    Input input;
    input.advance = 60.0;
    constexpr double dt = 0.02;
    double impulse_ns = 0.0;
    for (int k = 0; k < 150; ++k) {
        step(*world, input, channels);
        map.add(*world, dt);
    }
    // The channels are means over the substeps of a step; the map takes the last one.  A run at rest tells no
    // difference.
    input.advance = 0.0;
    for (int k = 0; k < 50; ++k) step(*world, input, channels);
    ForceMap still(*world);
    for (int k = 0; k < 25; ++k) {
        step(*world, input, channels);
        still.add(*world, dt);
        impulse_ns += channels.wire_force_mn / units::newton * dt;
    }
    const std::string regions = still.regions_csv();
    double of_regions = 0.0;
    int rows = 0;
    CsvLines lines(regions);
    ASSERT_TRUE(lines.next());
    while (lines.next()) {
        of_regions += finite_number(lines.cells()[2]).value();
        ++rows;
    }
    EXPECT_GT(rows, 0);
    EXPECT_GT(impulse_ns, 1e-3);
    EXPECT_NEAR(of_regions, impulse_ns, 0.05 * impulse_ns);
    // The wire lies on the way from the groin to the heart.
    EXPECT_NEAR(sum(still.unrolled().impulse_ns), of_regions, 1e-9);
    EXPECT_GT(sum(map.unrolled().impulse_ns), 0.0);

    const UnrolledForces again = parse_force_map(force_map_csv(map.unrolled()), "force-map.csv");
    EXPECT_EQ(force_map_csv(again), force_map_csv(map.unrolled()));
}

TEST(UnrolledForces, TwoAddUpWhateverTheirLength) {
    UnrolledForces one{{1.0, 2.0}}, two{{0.5, 0.0, 3.0}};
    one.add(two);
    EXPECT_EQ(one.impulse_ns, (std::vector<double>{1.5, 2.0, 3.0}));
}

TEST(UnrolledForces, WhatIsNoTableIsRefusedByLine) {
    const std::string head = "along_mm,angle_deg,impulse_ns\n";
    EXPECT_TRUE(parse_force_map(head, "f").impulse_ns.empty());
    for (const char* row : {"5,15", "5,15,x", "5,15,nan", "5,360,1", "-5,15,1", "5,15,-1", "1e9,15,1", "5,15,1,2"}) {
        try {
            parse_force_map(head + "5,15,1\n" + row + "\n", "f.csv");
            ADD_FAILURE() << row;
        } catch (const UserError& error) {
            EXPECT_NE(std::string(error.what()).find("f.csv:3"), std::string::npos) << error.what();
        }
    }
    EXPECT_THROW(parse_force_map("", "f"), UserError);
    EXPECT_THROW(parse_force_map("a,b\n", "f"), UserError);
}

}  // namespace
}  // namespace cathlab
