// Lost motion between drive and catheter: each axis follows its command through a gap.  `..._mm`, `..._deg` are the
// widths of the gaps, that is the motion lost at a reversal:
//     q <- play(command, q, width / 2),
// for a segment in the plane of its bend vector (a round clearance).  At the start the device stands in the middle of
// each gap [nordin2002].
#include "core/units.h"
#include "effects/play.h"

namespace cathlab {
namespace {

class Backlash final : public Effect {
public:
    explicit Backlash(std::span<const double> p)
        : insertion_mm_(p[0]),
          rotation_(p[1] * units::deg),
          bend_{p[2] * units::deg, p[3] * units::deg, p[4] * units::deg} {}

    void actuation(const EffectContext& /*context*/, Actuation& act) override {
        const std::size_t n = act.segments.size();
        if (!started_) {
            started_ = true;
            at_mm_ = act.insertion_mm;
            at_rad_ = act.rotation_rad;
            for (const ActuatedSegment& s : act.segments) at_bend_.push_back(s.bend_rad);
        }
        act.insertion_mm = at_mm_ = play(act.insertion_mm, at_mm_, 0.5 * insertion_mm_);
        act.rotation_rad = at_rad_ = play(act.rotation_rad, at_rad_, 0.5 * rotation_);
        for (std::size_t i = 0; i < n; ++i)
            act.segments[i].bend_rad = at_bend_[i] =
                play(act.segments[i].bend_rad, at_bend_[i], 0.5 * of_segment(i, n, bend_[0], bend_[1], bend_[2]));
    }

    void visit(Archive& archive) override {
        archive.field("insertion_mm", at_mm_);
        archive.field("rotation_rad", at_rad_);
        visit_bends(archive, "bend_rad", at_bend_);
    }

private:
    double insertion_mm_, rotation_;
    double bend_[3];
    bool started_ = false;
    double at_mm_ = 0.0, at_rad_ = 0.0;
    std::vector<Vec2> at_bend_;
};

}  // namespace

EffectInfo backlash_effect() {
    return {
        .name = "backlash",
        .doc = "lost motion between drive and catheter: each axis follows through a gap",
        .source = "nordin2002",
        .hooks = hook_actuation,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip"},
        .parameters = {{"insertion_mm", "mm", 1.0, 0.0, 20.0, "motion of the shaft lost at a reversal"},
                       {"rotation_deg", "deg", 5.0, 0.0, 90.0, "rotation lost at a reversal"},
                       {"proximal_deg", "deg", 4.0, 0.0, 60.0, "bend of the first segment lost at a reversal"},
                       {"middle_deg", "deg", 4.0, 0.0, 60.0, "bend lost in each segment between first and last"},
                       {"distal_deg", "deg", 4.0, 0.0, 60.0, "bend of the last segment lost at a reversal"}},
        .strengths = {"insertion_mm", "rotation_deg", "proximal_deg", "middle_deg", "distal_deg"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<Backlash>(p); },
    };
}

}  // namespace cathlab
