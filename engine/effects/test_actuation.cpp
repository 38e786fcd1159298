// Proves the hook `actuation`: every bend is a factor of what was asked for.
#include "effects/effect.h"

namespace cathlab {
namespace {

class TestActuation final : public Effect {
public:
    explicit TestActuation(double gain) : gain_(gain) {}
    void actuation(const EffectContext& /*context*/, Actuation& act) override {
        for (ActuatedSegment& s : act.segments) s.bend_rad *= gain_;
    }

private:
    double gain_;
};

}  // namespace

EffectInfo test_actuation_effect() {
    return {
        .name = "test_actuation",
        .doc = "every bend is a factor of what was asked for",
        .source = "",
        .hooks = hook_actuation,
        .for_tests = true,
        .applies_to = {},
        .parameters = {{"gain", "1", 1.0, -2.0, 2.0, "strength"}},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<TestActuation>(p[0]);
        },
    };
}

}  // namespace cathlab
