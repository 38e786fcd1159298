// Metal near an electromagnetic tracker bends its field, and the readings with it, the more the farther from its
// transmitter [franz2014].  To second order about the origin of the readings, with r = |p| / 100 mm,
//     p -> p + r^2 (push + swell p / |p|).
#include <cmath>

#include "effects/effect.h"
#include "effects/sensor.h"

namespace cathlab {
namespace {

class FieldDistortion final : public Effect {
public:
    explicit FieldDistortion(std::span<const double> p) : swell_(p[0]), push_(p[1], p[2], p[3]) {}
    void measure(const EffectContext& /*context*/, Channels& channels) override {
        for_each_tip(channels, [&](int, const Vec3& p) {
            const double far = std::sqrt(p.squaredNorm());
            const double square = far * far / 1e4;
            Vec3 out = p + square * push_;
            if (far > 0.0) out += square * swell_ / far * p;
            return out;
        });
    }

private:
    double swell_;
    Vec3 push_;
};

}  // namespace

EffectInfo field_distortion_effect() {
    return {
        .name = "field_distortion",
        .doc = "metal bends the tracker's field: readings go wrong with the square of the distance",
        .source = "franz2014",
        .hooks = hook_measure,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip"},
        .parameters = {{"swell_mm", "mm", 1.0, -20.0, 20.0, "away from the origin, at 100 mm"},
                       {"push_x_mm", "mm", 0.0, -20.0, 20.0, "along x, at 100 mm"},
                       {"push_y_mm", "mm", 0.0, -20.0, 20.0, "along y, at 100 mm"},
                       {"push_z_mm", "mm", 0.0, -20.0, 20.0, "along z, at 100 mm"}},
        .strengths = {"swell_mm", "push_x_mm", "push_y_mm", "push_z_mm"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<FieldDistortion>(p);
        },
    };
}

}  // namespace cathlab
