// Proves the hook `force`: a uniform acceleration acts on the wall along z.
#include "effects/effect.h"

namespace cathlab {
namespace {

class TestForce final : public Effect {
public:
    explicit TestForce(double acceleration_mm_s2) : acceleration_mm_s2_(acceleration_mm_s2) {}
    void force(const EffectContext& context, std::span<Vec3> force) override {
        for (std::size_t i = 0; i < force.size(); ++i) force[i].z() += context.wall_mass[i] * acceleration_mm_s2_;
    }

private:
    double acceleration_mm_s2_;
};

}  // namespace

EffectInfo test_force_effect() {
    return {
        .name = "test_force",
        .doc = "a uniform acceleration acts on the wall along z",
        .source = "",
        .hooks = hook_force,
        .for_tests = true,
        .applies_to = {},
        .parameters = {{"acceleration_mm_s2", "mm/s2", 0.0, -100000.0, 100000.0, "strength"}},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<TestForce>(p[0]); },
    };
}

}  // namespace cathlab
