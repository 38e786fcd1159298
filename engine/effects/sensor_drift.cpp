// The sensor's zero creeps: readings move by a rate times the time since the recording began [wiles2004].
#include "effects/effect.h"
#include "effects/sensor.h"

namespace cathlab {
namespace {

class SensorDrift final : public Effect {
public:
    explicit SensorDrift(std::span<const double> p) : per_s_(Vec3(p[0], p[1], p[2]) / 60.0) {}
    void measure(const EffectContext& context, Channels& channels) override {
        const Vec3 drift = (context.time_s + context.dt) * per_s_;
        for_each_tip(channels, [&](int, const Vec3& p) { return Vec3(p + drift); });
        channels.annulus_displacement_mm += drift.z();
    }

private:
    Vec3 per_s_;
};

}  // namespace

EffectInfo sensor_drift_effect() {
    return {
        .name = "sensor_drift",
        .doc = "the sensor's zero creeps with time",
        .source = "wiles2004",
        .hooks = hook_measure,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip", "heart-motion", "wall-contact"},
        .parameters = {{"x_mm_min", "mm/min", 0.0, -60.0, 60.0, "drift a minute, x"},
                       {"y_mm_min", "mm/min", 0.0, -60.0, 60.0, "drift a minute, y"},
                       {"z_mm_min", "mm/min", 1.0, -60.0, 60.0, "drift a minute, z, and along the heart's axis"}},
        .strengths = {"x_mm_min", "y_mm_min", "z_mm_min"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<SensorDrift>(p); },
    };
}

}  // namespace cathlab
