// The whole body, or what the sensor's frame stands on, moves slowly to and fro: all supports go by
//     u(t) = a sin(2 pi (t / T + phase)),
// a vector a.  Slower than breathing and without its pause at expiration [sornmo2005].
#include "core/deterministic_math.h"
#include "core/units.h"
#include "effects/effect.h"

namespace cathlab {
namespace {

class BaselineWander final : public Effect {
public:
    explicit BaselineWander(std::span<const double> p) : amplitude_(p[0], p[1], p[2]), period_(p[3]), phase_(p[4]) {}
    void drive(const EffectContext& context, Drive& drive) override {
        const double t = context.time_s + context.dt;
        const Vec3 u = det::sin(2.0 * units::pi * (t / period_ + phase_)) * amplitude_;
        for (Vec3& support : drive.support_displacement) support += u;
    }

private:
    Vec3 amplitude_;
    double period_, phase_;
};

}  // namespace

EffectInfo baseline_wander_effect() {
    return {
        .name = "baseline_wander",
        .doc = "everything moves slowly to and fro, as a body that does not lie still",
        .source = "sornmo2005",
        .hooks = hook_drive,
        .for_tests = false,
        .applies_to = {"heart-motion"},
        .parameters = {{"amplitude_x_mm", "mm", 0.0, -30.0, 30.0, "to the patient's left"},
                       {"amplitude_y_mm", "mm", 0.0, -30.0, 30.0, "to the back"},
                       {"amplitude_z_mm", "mm", 1.0, -30.0, 30.0, "to the head"},
                       {"period_s", "s", 20.0, 6.0, 300.0, "of the motion"},
                       {"phase", "1", 0.0, 0.0, 1.0, "at time 0"}},
        .strengths = {"amplitude_x_mm", "amplitude_y_mm", "amplitude_z_mm"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<BaselineWander>(p);
        },
    };
}

}  // namespace cathlab
