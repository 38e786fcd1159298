// Proves the hook `material`: the wall is stiffer by a factor.
#include "effects/effect.h"

namespace cathlab {
namespace {

class TestMaterial final : public Effect {
public:
    explicit TestMaterial(double factor) : factor_(factor) {}
    void material(const EffectContext& /*context*/, std::span<double> stiffness_scale) override {
        for (double& s : stiffness_scale) s *= factor_;
    }

private:
    double factor_;
};

}  // namespace

EffectInfo test_material_effect() {
    return {
        .name = "test_material",
        .doc = "the wall is stiffer by a factor",
        .source = "",
        .hooks = hook_material,
        .for_tests = true,
        .applies_to = {},
        .parameters = {{"factor", "1", 1.0, 0.01, 100.0, "strength"}},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<TestMaterial>(p[0]);
        },
    };
}

}  // namespace cathlab
