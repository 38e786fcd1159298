// The drive is not calibrated: each axis does (1 + error) times what it is told [camarillo2009].
#include "effects/play.h"

namespace cathlab {
namespace {

class ActuationGain final : public Effect {
public:
    explicit ActuationGain(std::span<const double> p) : insertion_(p[0]), rotation_(p[1]), bend_{p[2], p[3], p[4]} {}

    void actuation(const EffectContext& /*context*/, Actuation& act) override {
        const std::size_t n = act.segments.size();
        act.insertion_mm += insertion_ * act.insertion_mm;
        act.rotation_rad += rotation_ * act.rotation_rad;
        for (std::size_t i = 0; i < n; ++i)
            act.segments[i].bend_rad += of_segment(i, n, bend_[0], bend_[1], bend_[2]) * act.segments[i].bend_rad;
    }

private:
    double insertion_, rotation_;
    double bend_[3];
};

}  // namespace

EffectInfo actuation_gain_effect() {
    return {
        .name = "actuation_gain",
        .doc = "each axis of the catheter does more or less than it is told",
        .source = "camarillo2009",
        .hooks = hook_actuation,
        .for_tests = false,
        .applies_to = {"catheter-tip"},  // where tendons are recorded their gains are the base model's
        .parameters = {{"insertion", "1", 0.0, -0.6, 0.6, "insertion: what comes over what is asked, less 1"},
                       {"rotation", "1", 0.0, -0.6, 0.6, "the same of the rotation"},
                       {"proximal", "1", -0.1, -0.6, 0.6, "the same of the first segment's bend"},
                       {"middle", "1", 0.0, -0.6, 0.6, "the same of the segments between first and last"},
                       {"distal", "1", -0.1, -0.6, 0.6, "the same of the last segment's bend"}},
        .strengths = {"insertion", "rotation", "proximal", "middle", "distal"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<ActuationGain>(p); },
    };
}

}  // namespace cathlab
