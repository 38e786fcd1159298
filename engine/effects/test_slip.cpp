// Proves the hook `slip`: what holds the wall follows what pulls at it.
#include "effects/effect.h"

namespace cathlab {
namespace {

class TestSlip final : public Effect {
public:
    explicit TestSlip(double mm_per_kpa) : mm_per_kpa_(mm_per_kpa) {}
    void slip(const EffectContext& /*context*/, HeldPoint& held) override {
        held.slipped += mm_per_kpa_ * held.traction;
    }

private:
    double mm_per_kpa_;
};

}  // namespace

EffectInfo test_slip_effect() {
    return {
        .name = "test_slip",
        .doc = "what holds the wall is a spring",
        .source = "",
        .hooks = hook_slip,
        .for_tests = true,
        .applies_to = {},
        .parameters = {{"mm_per_kpa", "mm/kPa", 0.0, 0.0, 100.0, "strength"}},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<TestSlip>(p[0]); },
    };
}

}  // namespace cathlab
