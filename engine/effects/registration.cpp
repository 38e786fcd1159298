// The tracker's frame is not the model's: every place is read turned and shifted,
//     p_read = R(turn) p + offset,
// turn a rotation vector about the world's origin [fitzpatrick2001].
#include "core/deterministic_math.h"
#include "core/units.h"
#include "effects/effect.h"
#include "effects/sensor.h"

namespace cathlab {
namespace {

class Registration final : public Effect {
public:
    explicit Registration(std::span<const double> p)
        : turn_(det::rotation_from_vector(units::deg * Vec3(p[0], p[1], p[2]))), offset_(p[3], p[4], p[5]) {}
    void measure(const EffectContext& /*context*/, Channels& channels) override {
        for_each_tip(channels, [&](int, const Vec3& p) { return Vec3(turn_ * p + offset_); });
    }

private:
    Quat turn_;
    Vec3 offset_;
};

}  // namespace

EffectInfo registration_effect() {
    return {
        .name = "registration",
        .doc = "the tracker's frame is turned and shifted against the model's",
        .source = "fitzpatrick2001",
        .hooks = hook_measure,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip", "wall-contact"},
        .parameters = {{"turn_x_deg", "deg", 0.0, -15.0, 15.0, "rotation vector, x"},
                       {"turn_y_deg", "deg", 0.0, -15.0, 15.0, "rotation vector, y"},
                       {"turn_z_deg", "deg", 0.0, -15.0, 15.0, "rotation vector, z"},
                       {"offset_x_mm", "mm", 1.0, -50.0, 50.0, "shift, x"},
                       {"offset_y_mm", "mm", 0.0, -50.0, 50.0, "shift, y"},
                       {"offset_z_mm", "mm", 0.0, -50.0, 50.0, "shift, z"}},
        .strengths = {"turn_x_deg", "turn_y_deg", "turn_z_deg", "offset_x_mm", "offset_y_mm", "offset_z_mm"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<Registration>(p); },
    };
}

}  // namespace cathlab
