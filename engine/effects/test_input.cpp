// Proves the hook `input`: the device advances by a factor of what the operator asked for.
#include "effects/effect.h"

namespace cathlab {
namespace {

class TestInput final : public Effect {
public:
    explicit TestInput(double gain) : gain_(gain) {}
    void input(const EffectContext& /*context*/, Input& input) override { input.advance *= gain_; }

private:
    double gain_;
};

}  // namespace

EffectInfo test_input_effect() {
    return {
        .name = "test_input",
        .doc = "the device advances by a factor of what the operator asked for",
        .source = "",
        .hooks = hook_input,
        .for_tests = true,
        .applies_to = {},
        .parameters = {{"gain", "1", 1.0, -2.0, 2.0, "strength"}},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<TestInput>(p[0]); },
    };
}

}  // namespace cathlab
