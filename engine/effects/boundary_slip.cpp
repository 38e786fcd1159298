// What holds the wall gives way: below a threshold it sticks, beyond it slides by so much a kPa of the section, and it
// stays there until it is pulled back as far (the play operator of friction in series with a spring
// [krasnoselskii1989]):
//     slipped = compliance play(traction, threshold).
#include "effects/play.h"

namespace cathlab {
namespace {

class BoundarySlip final : public Effect {
public:
    BoundarySlip(double compliance, double threshold) : compliance_(compliance), threshold_(threshold) {}

    void slip(const EffectContext& /*context*/, HeldPoint& held) override {
        held.slipped += compliance_ * played(held);
    }
    void remember_slip(const EffectContext& /*context*/, const HeldPoint& held) override {
        const Vec3 now = played(held);
        if (held.index >= played_.size()) played_.resize(held.index + 1, Vec3::Zero());
        played_[held.index] = now;
    }
    void visit(Archive& archive) override { archive.field("played_kpa", played_); }

private:
    Vec3 played(const HeldPoint& held) const {
        const Vec3 before = held.index < played_.size() ? played_[held.index] : Vec3(Vec3::Zero());
        const Vec3 d = held.traction - before;
        const double n = std::sqrt(d.squaredNorm());
        return n <= threshold_ ? before : Vec3(held.traction - (threshold_ / n) * d);
    }

    double compliance_, threshold_;
    std::vector<Vec3> played_;  // (held points) kPa
};

}  // namespace

EffectInfo boundary_slip_effect() {
    return {
        .name = "boundary_slip",
        .doc = "what holds the wall slides: grips, clamps, the tissue at its ends",
        .source = "krasnoselskii1989",
        .hooks = hook_slip,
        .for_tests = false,
        .applies_to = {"wall-tension", "wall-contact"},
        .parameters = {{"mm_per_kpa", "mm/kPa", 0.002, 0.0, 1.0,
                        "slip for each kPa of the section beyond the threshold"},
                       {"threshold_kpa", "kPa", 5.0, 0.0, 1000.0, "traction up to which it sticks"}},
        .strengths = {"mm_per_kpa"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<BoundarySlip>(p[0], p[1]);
        },
    };
}

}  // namespace cathlab
