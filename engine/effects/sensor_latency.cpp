// A reading tells where the tip was `delay_s` ago, straight between the places that were seen; before there is so much
// past, where it was first [wiles2004].
#include <algorithm>
#include <deque>

#include "effects/effect.h"
#include "effects/sensor.h"

namespace cathlab {
namespace {

class SensorLatency final : public Effect {
public:
    explicit SensorLatency(double delay_s) : delay_s_(delay_s) {}

    void measure(const EffectContext& context, Channels& channels) override {
        if (delay_s_ <= 0.0) return;
        const double now = context.time_s + context.dt;
        Seen seen;
        seen.time_s = now;
        for_each_tip(channels, [&](int which, const Vec3& p) { return seen.tip[which] = p; });
        seen.annulus_mm = channels.annulus_displacement_mm;
        past_.push_back(seen);
        while (past_.size() > 2 && past_[1].time_s <= now - delay_s_) past_.pop_front();
        double part = 0.0;
        const Seen &a = past_.front(), &b = past_.size() > 1 ? past_[1] : a;
        if (b.time_s > a.time_s) part = std::clamp((now - delay_s_ - a.time_s) / (b.time_s - a.time_s), 0.0, 1.0);
        for_each_tip(channels,
                     [&](int which, const Vec3&) { return Vec3(a.tip[which] + part * (b.tip[which] - a.tip[which])); });
        channels.annulus_displacement_mm = a.annulus_mm + part * (b.annulus_mm - a.annulus_mm);
    }

    void visit(Archive& archive) override {
        for (Seen& seen : past_) {
            archive.field("time_s", seen.time_s);
            archive.field("wire_tip", seen.tip[0]);
            archive.field("catheter_tip", seen.tip[1]);
            archive.field("annulus_mm", seen.annulus_mm);
        }
    }

private:
    struct Seen {
        double time_s = 0.0;
        Vec3 tip[2];
        double annulus_mm = 0.0;
    };
    double delay_s_;
    std::deque<Seen> past_;
};

}  // namespace

EffectInfo sensor_latency_effect() {
    return {
        .name = "sensor_latency",
        .doc = "the sensor tells where the tip was some time ago",
        .source = "wiles2004",
        .hooks = hook_measure,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip", "wall-contact"},
        .parameters = {{"delay_s", "s", 0.2, 0.0, 3.0, "age of a reading"}},
        .strengths = {"delay_s"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<SensorLatency>(p[0]);
        },
    };
}

}  // namespace cathlab
