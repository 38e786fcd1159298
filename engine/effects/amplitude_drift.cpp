// The beat grows or fades with time: excursion x (1 + rate t), never below 0.  A heart that tires, or contractility
// under a drug [klabunde2012].
#include <algorithm>

#include "effects/effect.h"

namespace cathlab {
namespace {

class AmplitudeDrift final : public Effect {
public:
    explicit AmplitudeDrift(double per_minute) : per_s_(per_minute / 60.0) {}
    void drive(const EffectContext& context, Drive& drive) override {
        drive.heart_amplitude_scale *= std::max(0.0, 1.0 + per_s_ * (context.time_s + context.dt));
    }

private:
    double per_s_;
};

}  // namespace

EffectInfo amplitude_drift_effect() {
    return {
        .name = "amplitude_drift",
        .doc = "the excursion of the beat grows or fades with time",
        .source = "klabunde2012",
        .hooks = hook_drive,
        .for_tests = false,
        .applies_to = {"heart-motion"},
        .parameters = {{"per_minute", "1/min", -0.2, -3.0, 3.0, "change of the excursion a minute, over its start"}},
        .strengths = {"per_minute"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<AmplitudeDrift>(p[0]);
        },
    };
}

}  // namespace cathlab
