// Proves the hook `measure`: the insertion sensor of the wire reads too much by an offset.
#include "effects/effect.h"

namespace cathlab {
namespace {

class TestMeasure final : public Effect {
public:
    explicit TestMeasure(double offset_mm) : offset_mm_(offset_mm) {}
    void measure(const EffectContext& /*context*/, Channels& channels) override {
        channels.wire_insertion_mm += offset_mm_;
    }

private:
    double offset_mm_;
};

}  // namespace

EffectInfo test_measure_effect() {
    return {
        .name = "test_measure",
        .doc = "the insertion sensor of the wire reads too much by an offset",
        .source = "",
        .hooks = hook_measure,
        .for_tests = true,
        .applies_to = {},
        .parameters = {{"offset_mm", "mm", 0.0, -100.0, 100.0, "strength"}},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<TestMeasure>(p[0]);
        },
    };
}

}  // namespace cathlab
