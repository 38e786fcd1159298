// Where what holds the wall slides, it slides by its law under what devices press on the wall, no more and no less.
#include "step/wall_slip.h"

#include <cstdio>

#include "step/rig.h"

namespace cathlab {
namespace {

constexpr double mm_per_kpa = 0.05;

class SlippingWall : public testing::TestWithParam<WallForm> {};

TEST_P(SlippingWall, AtRestEveryHeldPointHasSlippedByItsLawUnderWhatDevicesPressWith) {
    SceneSpec spec = rig_spec("fork");
    const bool elastic = GetParam() == WallForm::elastic;
    if (elastic) spec.wall.form = "elastic";
    spec.heart.enabled = false;
    for (SceneEffect& effect : spec.effects) effect.enabled = false;
    enable(spec, "boundary_slip", {{"mm_per_kpa", mm_per_kpa}, {"threshold_kpa", 0.0}});
    const auto models = build_models(spec, {});
    RigRun run(build_world(spec, *models, spec.seed, 1));
    run.step(push(60.0), 60);
    Input bent = push(30.0, 1.0);
    bent.proximal_bend = 60.0;
    bent.distal_bend = 40.0;
    run.step(bent, 100);
    bent.advance = 0.0;
    run.step(bent, elastic ? 2500 : 600);  // the elastic form comes to rest slowly
    std::vector<Vec3> on_wall(run.parts.wall->size(), Vec3::Zero());
    run.parts.contacts->apply_to_wall(on_wall);
    Vec3 pressed = Vec3::Zero();
    for (std::size_t i = 0; i < on_wall.size(); ++i)
        if (!run.parts.wall->fixed[i]) pressed += on_wall[i];
    const SoftBodyModel& wall = *run.parts.wall;
    const SoftBodyScratch& scratch = *run.parts.wall_scratch;
    solve_goals(wall, *run.parts.wall_state, *run.parts.wall_scratch, run.world->workers());  // of where it stands
    const std::vector<Vec3>& slipped = run.world->get<SlipState>(run.world->owner<SupportState>())->slipped_mm;
    Vec3 carried = Vec3::Zero();
    double most = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < wall.size(); ++i) {
        if (!wall.fixed[i]) {
            carried += wall.support[i] * (run.parts.wall_state->x[i] - wall.rest[i]);
            continue;
        }
        const double section = wall.thickness_mm[i] * std::sqrt(wall.area_mm2[i]);
        const Vec3 force =
            (elastic ? scratch.hold[i] : wall.stiffness[i]) * (scratch.goal[i] - run.parts.wall_state->x[i]);
        const Vec3 traction = force / section;
        carried += force;
        most = std::max(most, slipped[i].norm());
        worst = std::max(worst, (slipped[i] - mm_per_kpa * traction).norm());
    }
    std::printf("pressed %.1f mN, carried %.1f; slipped by %.4f mm at most, beside the law by %.6f\n", pressed.norm(),
                carried.norm(), most, worst);
    EXPECT_GT(pressed.norm(), 1.0);
    EXPECT_LT((carried - pressed).norm(), 0.01 * pressed.norm());
    EXPECT_GT(most, 1e-3);
    EXPECT_LT(worst, 0.01 * most);
}

INSTANTIATE_TEST_SUITE_P(OfEitherForm, SlippingWall, testing::Values(WallForm::clusters, WallForm::elastic),
                         [](const auto& info) { return info.param == WallForm::clusters ? "clusters" : "elastic"; });

}  // namespace
}  // namespace cathlab
