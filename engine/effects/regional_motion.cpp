// Every place of the heart, and what hangs on it, has a beat of its own beside that of the whole: fibres run
// differently from layer to layer and from base to apex, and activation takes time to arrive [torrentguasp2005].  With
// phi the phase of the beat, the first two of its harmonics:
//     u = c_1 (cos 2 pi phi - 1) + s_1 sin 2 pi phi + c_2 (cos 4 pi phi - 1) + s_2 sin 4 pi phi.
#include "core/deterministic_math.h"
#include "core/units.h"
#include "effects/effect.h"

namespace cathlab {
namespace {

class RegionalMotion final : public Effect {
public:
    explicit RegionalMotion(std::span<const double> p)
        : cos1_(p[0], p[1], p[2]), sin1_(p[3], p[4], p[5]), cos2_(p[6], p[7], p[8]), sin2_(p[9], p[10], p[11]) {}
    void drive(const EffectContext& context, Drive& drive) override {
        if (context.heart_beat_s <= 0.0) return;
        const double angle = 2.0 * units::pi * context.heart_phase, c = det::cos(angle), s = det::sin(angle);
        const Vec3 moved = (c - 1.0) * cos1_ + s * sin1_ + (c * c - s * s - 1.0) * cos2_ + 2.0 * s * c * sin2_;
        for (Vec3& u : drive.support_displacement) u += moved;
    }

private:
    Vec3 cos1_, sin1_, cos2_, sin2_;
};

}  // namespace

EffectInfo regional_motion_effect() {
    EffectInfo info = {
        .name = "regional_motion",
        .doc = "a place has a beat of its own beside that of the whole heart",
        .source = "torrentguasp2005",
        .hooks = hook_drive,
        .for_tests = false,
        .applies_to = {"heart-motion"},
        .parameters = {{"cos1_x_mm", "mm", 0.0, -20.0, 20.0, "once a beat, x"},
                       {"cos1_y_mm", "mm", 0.0, -20.0, 20.0, "once a beat, y"},
                       {"cos1_z_mm", "mm", 0.0, -20.0, 20.0, "once a beat, z"},
                       {"sin1_x_mm", "mm", 0.0, -20.0, 20.0, "once a beat, a quarter later, x"},
                       {"sin1_y_mm", "mm", 0.0, -20.0, 20.0, "once a beat, a quarter later, y"},
                       {"sin1_z_mm", "mm", 0.0, -20.0, 20.0, "once a beat, a quarter later, z"},
                       {"cos2_x_mm", "mm", 0.0, -20.0, 20.0, "twice a beat, x"},
                       {"cos2_y_mm", "mm", 0.0, -20.0, 20.0, "twice a beat, y"},
                       {"cos2_z_mm", "mm", 0.0, -20.0, 20.0, "twice a beat, z"},
                       {"sin2_x_mm", "mm", 0.0, -20.0, 20.0, "twice a beat, a quarter later, x"},
                       {"sin2_y_mm", "mm", 0.0, -20.0, 20.0, "twice a beat, a quarter later, y"},
                       {"sin2_z_mm", "mm", 0.0, -20.0, 20.0, "twice a beat, a quarter later, z"}},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<RegionalMotion>(p);
        },
    };
    for (const Parameter& p : info.parameters) info.strengths.push_back(p.key);
    return info;
}

}  // namespace cathlab
