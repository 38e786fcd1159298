// Effects between the catheter's drive and its shape, and on the heart, through the whole step.
#include <cmath>

#include "heart/motion.h"
#include "step/rig.h"

namespace cathlab {
namespace {

Input bent(double proximal_deg) {
    Input input;
    input.device = 1.0;
    input.proximal_bend = proximal_deg;
    return input;
}

TEST(ActuationHook, BacklashLosesItsWidthWhenTheBendTurnsBack) {
    SceneSpec spec = rig_spec("fork");
    spec.heart.enabled = spec.wire.enabled = false;
    spec.catheter.enabled = true;
    RigRun plain(spec, "fork");
    enable(spec, "backlash",
           {{"insertion_mm", 0.0}, {"rotation_deg", 0.0}, {"proximal_deg", 6.0}, {"distal_deg", 0.0}});
    RigRun slack(spec, "fork");
    for (int k = 0; k < 25; ++k) {
        plain.step(bent(10.0));
        slack.step(bent(k == 0 ? 0.0 : 10.0));
    }
    EXPECT_NEAR(plain.channels.catheter_proximal_bend_deg, 10.0, 1e-6);
    EXPECT_NEAR(slack.channels.catheter_proximal_bend_deg, 7.0, 1e-6);
    slack.step(bent(5.0), 25);
    EXPECT_NEAR(slack.channels.catheter_proximal_bend_deg, 7.0, 1e-6) << "5 of 6 deg are lost";
    slack.step(bent(2.0), 25);
    EXPECT_NEAR(slack.channels.catheter_proximal_bend_deg, 5.0, 1e-6);
}

TEST(ActuationHook, ALagComesLaterAndArrives) {
    SceneSpec spec = rig_spec("fork");
    spec.heart.enabled = spec.wire.enabled = false;
    spec.catheter.enabled = true;
    enable(spec, "actuation_lag", {{"bend_tau_s", 0.2}, {"rotation_tau_s", 0.0}, {"insertion_tau_s", 0.0}});
    RigRun run(spec, "fork");
    run.step(bent(0.0));
    run.step(bent(8.0), 10);
    EXPECT_GT(run.channels.catheter_proximal_bend_deg, 2.0);
    EXPECT_LT(run.channels.catheter_proximal_bend_deg, 6.5);
    run.step(bent(8.0), 100);
    EXPECT_NEAR(run.channels.catheter_proximal_bend_deg, 8.0, 1e-2);
}

}  // namespace
}  // namespace cathlab
