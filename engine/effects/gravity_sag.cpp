// The steerable part bends under its own weight, as a cantilever of uniform weight w and stiffness EI [gere2008]:
//     d bend / d s = M(s) / EI,   M(s) = sum over all that is beyond s of (x - x_s) x w ds down,
// taken on the shape that the drive asks for (first order).  w / EI follows from the drop of the straight steerable
// part of length L that is held level by its base: drop = w L^4 / (8 EI).
#include <cmath>

#include "core/deterministic_math.h"
#include "effects/effect.h"

namespace cathlab {
namespace {

constexpr int parts = 4;  // of a segment

struct Part {
    Vec3 middle;  // frame of the base
    Quat frame;
    double length;
    std::size_t segment;  // == count: a straight link or tip
};

class GravitySag final : public Effect {
public:
    explicit GravitySag(std::span<const double> p) : drop_mm_(p[0]) {}

    void actuation(const EffectContext& /*context*/, Actuation& act) override {
        if (act.down == Vec3::Zero() || drop_mm_ == 0.0) return;
        lay(act);
        double all = 0.0;
        for (const Part& p : parts_) all += p.length;
        const double load = 8.0 * drop_mm_ / (all * all * all * all);  // w / EI, 1/mm^3
        Vec3 first = Vec3::Zero();                                     // of what is beyond: sum of ds x
        double beyond = 0.0;                                           // sum of ds
        for (std::size_t k = parts_.size(); k-- > 0;) {
            const Part& p = parts_[k];
            if (p.segment < act.segments.size()) {
                // What of the part itself lies beyond: L^2 / 8 at its middle, L^2 / 6 on average over it.
                const Vec3 own = p.length * p.length / 6.0 * (p.frame * Vec3::UnitZ());
                const Vec3 moment = (first - beyond * p.middle + own).cross(load * act.down);
                const Vec3 turn = p.frame.conjugate() * (p.length * moment);
                act.segments[p.segment].bend_rad += Vec2(turn.y(), -turn.x());
            }
            first += p.length * p.middle;
            beyond += p.length;
        }
    }

private:
    void lay(const Actuation& act) {
        parts_.clear();
        Vec3 at = Vec3::Zero();
        Quat frame = Quat::Identity();
        const auto straight = [&](double length, std::size_t segment) {
            const Vec3 ahead = frame * Vec3::UnitZ();
            if (length > 0.0) parts_.push_back({at + 0.5 * length * ahead, frame, length, segment});
            at += length * ahead;
        };
        const std::size_t none = act.segments.size();
        for (std::size_t i = 0; i < none; ++i) {
            if (i > 0) straight(act.link_length_mm, none);
            const Vec2 bend = act.segments[i].bend_rad / parts;
            const Quat half = det::rotation_from_vector(0.5 * Vec3(-bend.y(), bend.x(), 0.0));
            for (int k = 0; k < parts; ++k) {
                frame = frame * half;
                straight(act.segments[i].length_mm / parts, i);
                frame = frame * half;
            }
        }
        straight(act.tip_length_mm, none);
    }

    double drop_mm_;
    std::vector<Part> parts_;  // scratch
};

}  // namespace

EffectInfo gravity_sag_effect() {
    return {
        .name = "gravity_sag",
        .doc = "the steerable part bends under its own weight",
        .source = "gere2008",
        .hooks = hook_actuation,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip"},
        .parameters = {{"drop_mm", "mm", 3.0, 0.0, 80.0, "drop of the tip of the straight steerable part, held level"}},
        .strengths = {"drop_mm"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<GravitySag>(p); },
    };
}

}  // namespace cathlab
