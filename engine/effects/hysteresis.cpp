// Friction of cables in their sheaths: a Prandtl-Ishlinskii operator [krasnoselskii1989].  A share of each segment's
// bend is carried by six plays in parallel whose radii are spread evenly up to `width_deg`:
//     bend = (1 - s) command + s / 6 sum_k P_k,     P_k <- play(command, P_k, k / 6 width).
// Minor loops close; unlike backlash there is no dead motion, since the rest of the share follows at once.
#include "core/units.h"
#include "effects/play.h"

namespace cathlab {
namespace {

constexpr std::size_t plays = 6;

class Hysteresis final : public Effect {
public:
    explicit Hysteresis(std::span<const double> p) : share_{p[0], p[1], p[2]}, width_(p[3] * units::deg) {}

    void actuation(const EffectContext& /*context*/, Actuation& act) override {
        const std::size_t n = act.segments.size();
        if (state_.empty())
            for (const ActuatedSegment& s : act.segments) state_.insert(state_.end(), plays, s.bend_rad);
        for (std::size_t i = 0; i < n; ++i) {
            Vec2& bend = act.segments[i].bend_rad;
            Vec2 behind = Vec2::Zero();  // how far the plays stay behind, on average
            for (std::size_t k = 0; k < plays; ++k) {
                Vec2& p = state_[plays * i + k];
                p = play(bend, p, width_ * static_cast<double>(k + 1) / static_cast<double>(plays));
                behind += (p - bend) / static_cast<double>(plays);
            }
            bend += of_segment(i, n, share_[0], share_[1], share_[2]) * behind;
        }
    }

    void visit(Archive& archive) override { visit_bends(archive, "bend_rad", state_); }

private:
    double share_[3];
    double width_;
    std::vector<Vec2> state_;  // (segments x plays)
};

}  // namespace

EffectInfo hysteresis_effect() {
    return {
        .name = "hysteresis",
        .doc = "friction of the cables: part of each bend follows its command through plays of many widths",
        .source = "krasnoselskii1989",
        .hooks = hook_actuation,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip"},
        .parameters = {{"proximal", "1", 0.3, 0.0, 0.95, "share of the first segment's bend that friction holds"},
                       {"middle", "1", 0.3, 0.0, 0.95, "the same of each segment between first and last"},
                       {"distal", "1", 0.3, 0.0, 0.95, "the same of the last segment"},
                       {"width_deg", "deg", 20.0, 1.0, 180.0, "radius of the widest play"}},
        .strengths = {"proximal", "middle", "distal"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<Hysteresis>(p); },
    };
}

}  // namespace cathlab
