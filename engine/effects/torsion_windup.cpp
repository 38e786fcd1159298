// The shaft winds up: friction along it holds it back, and the longer it lies in the sheath and vessel the more it
// twists before its tip turns.  The tip's rotation follows the drive's through a play whose radius grows with the
// length that is inserted, and lags no more than a torque twists a shaft [gere2008]:
//     tip <- play(drive, tip, base + per_100mm insertion / 100).
#include <algorithm>

#include "core/units.h"
#include "effects/play.h"

namespace cathlab {
namespace {

class TorsionWindup final : public Effect {
public:
    TorsionWindup(double base_deg, double per_100mm_deg)
        : base_(base_deg * units::deg), per_mm_(per_100mm_deg * units::deg / 100.0) {}

    void actuation(const EffectContext& /*context*/, Actuation& act) override {
        if (!started_) {
            started_ = true;
            tip_ = act.rotation_rad;
        }
        const double twist = base_ + per_mm_ * std::max(0.0, act.insertion_mm);
        act.rotation_rad = tip_ = play(act.rotation_rad, tip_, twist);
    }
    void visit(Archive& archive) override { archive.field("tip_rad", tip_); }

private:
    double base_, per_mm_;
    bool started_ = false;
    double tip_ = 0.0;
};

}  // namespace

EffectInfo torsion_windup_effect() {
    return {
        .name = "torsion_windup",
        .doc = "the shaft winds up before its tip turns, the more the longer it is",
        .source = "gere2008",
        .hooks = hook_actuation,
        .for_tests = false,
        .applies_to = {"catheter-tip"},
        .parameters = {{"base_deg", "deg", 2.0, 0.0, 90.0, "twist that friction holds with nothing inserted"},
                       {"per_100mm_deg", "deg", 10.0, 0.0, 360.0, "the same for each 100 mm of insertion"}},
        .strengths = {"base_deg", "per_100mm_deg"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<TorsionWindup>(p[0], p[1]);
        },
    };
}

}  // namespace cathlab
