// The heart's rate is not even: rate x (1 + share sin(2 pi (t / T + phase))), as breathing makes it (respiratory sinus
// arrhythmia) and slower rhythms [taskforce1996].
#include "core/deterministic_math.h"
#include "core/units.h"
#include "effects/effect.h"

namespace cathlab {
namespace {

class RateVariability final : public Effect {
public:
    explicit RateVariability(std::span<const double> p) : share_(p[0]), period_(p[1]), phase_(p[2]) {}
    void drive(const EffectContext& context, Drive& drive) override {
        const double t = context.time_s + 0.5 * context.dt;  // the mean over the step, to first order
        drive.heart_rate_scale *= 1.0 + share_ * det::sin(2.0 * units::pi * (t / period_ + phase_));
    }

private:
    double share_, period_, phase_;
};

}  // namespace

EffectInfo rate_variability_effect() {
    return {
        .name = "rate_variability",
        .doc = "the heart's rate rises and falls, with the breath or slower",
        .source = "taskforce1996",
        .hooks = hook_drive,
        .for_tests = false,
        .applies_to = {"heart-motion"},
        .parameters = {{"share", "1", 0.05, 0.0, 0.6, "largest change of the rate over the rate"},
                       {"period_s", "s", 4.0, 2.0, 120.0, "of the change"},
                       {"phase", "1", 0.0, 0.0, 1.0, "at time 0; 0 = the rate is usual and rises"}},
        .strengths = {"share"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<RateVariability>(p);
        },
    };
}

}  // namespace cathlab
