// Proves the hook `membrane`: the wall's stress is multiplied.
#include "effects/effect.h"

namespace cathlab {
namespace {

class TestMembrane final : public Effect {
public:
    explicit TestMembrane(double factor) : factor_(factor) {}
    void stress(const EffectContext& /*context*/, MembranePoint& point) override {
        point.stress *= factor_;
        point.at_once *= factor_;
    }

private:
    double factor_;
};

}  // namespace

EffectInfo test_membrane_effect() {
    return {
        .name = "test_membrane",
        .doc = "the stress of an elastic wall is multiplied",
        .source = "",
        .hooks = hook_membrane,
        .for_tests = true,
        .applies_to = {},
        .parameters = {{"factor", "1", 1.0, 0.01, 100.0, "strength"}},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<TestMembrane>(p[0]);
        },
        .elastic_wall = true,
    };
}

}  // namespace cathlab
