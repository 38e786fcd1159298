// The rest shape follows the last excursion: polymer and braid set where the segment was held [lockett1972].  Each
// segment has a memory M of its bend, which goes towards the bend as that travels and as time passes,
//     dM = (command - M) (per_deg |d command| + per_s dt),
// and the bend is command + share (M - command): after an excursion the segment comes back a share short.
#include <cmath>

#include "core/deterministic_math.h"
#include "core/units.h"
#include "effects/play.h"

namespace cathlab {
namespace {

class RestMemory final : public Effect {
public:
    explicit RestMemory(std::span<const double> p)
        : share_{p[0], p[1], p[2]}, per_rad_(p[3] / units::deg), per_s_(p[4]) {}

    void actuation(const EffectContext& context, Actuation& act) override {
        const std::size_t n = act.segments.size();
        if (memory_.empty())
            for (const ActuatedSegment& s : act.segments) {
                memory_.push_back(s.bend_rad);
                before_.push_back(s.bend_rad);
            }
        for (std::size_t i = 0; i < n; ++i) {
            const Vec2 now = act.segments[i].bend_rad;
            const double travel = std::sqrt((now - before_[i]).squaredNorm());
            const double x = per_rad_ * travel + per_s_ * context.dt;
            memory_[i] = relaxed<Vec2>(memory_[i], before_[i], now, x, det::exp(-x));
            before_[i] = now;
            act.segments[i].bend_rad += of_segment(i, n, share_[0], share_[1], share_[2]) * (memory_[i] - now);
        }
    }

    void visit(Archive& archive) override {
        visit_bends(archive, "memory_rad", memory_);
        visit_bends(archive, "before_rad", before_);
    }

private:
    double share_[3];
    double per_rad_, per_s_;
    std::vector<Vec2> memory_, before_;
};

}  // namespace

EffectInfo rest_memory_effect() {
    return {
        .name = "rest_memory",
        .doc = "the rest shape of each segment follows its last excursion",
        .source = "lockett1972",
        .hooks = hook_actuation,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip"},
        .parameters = {{"proximal", "1", 0.1, -0.8, 0.8, "share of the way back that the first segment keeps"},
                       {"middle", "1", 0.1, -0.8, 0.8, "the same of each segment between first and last"},
                       {"distal", "1", 0.1, -0.8, 0.8, "the same of the last segment"},
                       {"per_deg", "1/deg", 0.02, 0.0, 0.5, "part of the memory that is written anew a degree of bend"},
                       {"per_s", "1/s", 0.0, 0.0, 2.0, "part of the memory that is written anew a second"}},
        .strengths = {"proximal", "middle", "distal"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<RestMemory>(p); },
    };
}

}  // namespace cathlab
