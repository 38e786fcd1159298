// Breathing moves what the vessels hang on.  Displacement of a support at height z:
//     u(z, t) = a w(z) c(t / T) d,   c = max(0, sin^(2 n)(pi s) - rest) / (1 - rest),
// the breathing curve of Lujan et al. (1999), which dwells at end-expiration the longer the larger n is, and time
// counted from there; s spends the part `inspiration` of a breath on the way from 0 to 1/2.  What comes to lie against
// something before the breath is out (a stage against its stop) is still for the part of the curve below `rest`.  A
// breath that is held stands until `held_until_s` where it then sets in.  w falls from 1 at and above the diaphragm's
// height to 0 at the pelvis, because bone holds the iliac arteries.
#include <algorithm>
#include <cmath>

#include "core/deterministic_math.h"
#include "core/units.h"
#include "effects/effect.h"

namespace cathlab {
namespace {

class Respiration final : public Effect {
public:
    explicit Respiration(std::span<const double> p)
        : amplitude_(p[0]),
          period_(p[1]),
          phase_(p[2]),
          direction_(p[3], p[4], p[5]),
          upper_(p[6]),
          lower_(p[7]),
          dwell_(p[8]),
          inspiration_(p[9]),
          rest_(p[10]),
          held_until_(p[11]) {
        const double n = std::sqrt(direction_.squaredNorm());
        direction_ = n > 0.0 ? Vec3(direction_ / n) : Vec3(0.0, 0.0, -1.0);
    }

    void drive(const EffectContext& context, Drive& drive) override {
        const double now = std::max(context.time_s + context.dt, held_until_);
        double place = now / period_ + phase_;
        if (inspiration_ != 0.5) {
            place -= std::floor(place);
            place = place < inspiration_ ? 0.5 * place / inspiration_
                                         : 0.5 + 0.5 * (place - inspiration_) / (1.0 - inspiration_);
        }
        const double s = det::sin(units::pi * place);
        double curve = dwell_ == 2.0 ? s * s * s * s : det::pow(s * s, dwell_);
        if (rest_ > 0.0) curve = std::max(0.0, (curve - rest_) / (1.0 - rest_));
        const double breath = amplitude_ * curve;
        for (std::size_t i = 0; i < drive.support_displacement.size(); ++i) {
            const double z = context.wall_rest[i].z();
            double w = upper_ > lower_ ? (z - lower_) / (upper_ - lower_) : 1.0;
            w = w < 0.0 ? 0.0 : (w > 1.0 ? 1.0 : w);
            drive.support_displacement[i] += breath * w * w * (3.0 - 2.0 * w) * direction_;
        }
    }

private:
    double amplitude_, period_, phase_;
    Vec3 direction_;
    double upper_, lower_, dwell_, inspiration_, rest_, held_until_;
};

}  // namespace

EffectInfo respiration_effect() {
    return {
        .name = "respiration",
        .doc = "breathing moves the supports of the vessels, most above the diaphragm and not at all in the pelvis",
        .source = "lujan1999",
        .hooks = hook_drive,
        .for_tests = false,
        .applies_to = {"catheter-tip", "heart-motion"},
        .parameters =
            {
                {"amplitude_mm", "mm", 6.0, 0.0, 40.0, "displacement at end-inspiration above the diaphragm"},
                {"period_s", "s", 4.0, 1.2, 8.0, "one breath: 7.5 to 50 a minute"},
                {"phase", "1", 0.0, 0.0, 1.0, "phase of the breath at time 0; 0 = end-expiration"},
                {"direction_x", "1", 0.0, -1.0, 1.0, "direction at inspiration, patient's left"},
                {"direction_y", "1", -0.3, -1.0, 1.0, "direction at inspiration, posterior"},
                {"direction_z", "1", -0.95, -1.0, 1.0, "direction at inspiration, cranial"},
                {"upper_z_mm", "mm", -100.0, -2000.0, 2000.0, "height from which on the supports move in full"},
                {"lower_z_mm", "mm", -300.0, -2000.0, 2000.0, "height below which they stand still"},
                {"dwell", "1", 2.0, 1.0, 4.0, "n: 1 = a sine, 2 = rests at end-expiration, more = rests longer"},
                {"inspiration", "1", 0.5, 0.2, 0.8, "part of a breath that inspiration takes"},
                {"rest", "1", 0.0, 0.0, 0.9, "part of the curve, from end-expiration, in which it lies still"},
                {"held_until_s", "s", 0.0, 0.0, 20.0, "until then the breath is held; 0 = it is not"},
            },
        .strengths = {"amplitude_mm"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<Respiration>(p); },
    };
}

}  // namespace cathlab
