// The cables of a segment run through those before it and bend them too [camarillo2009]:
//     bend_i = command_i + next command_{i+1} + far command_{i+2} + before command_{i-1}.
#include "effects/effect.h"

namespace cathlab {
namespace {

class SegmentCoupling final : public Effect {
public:
    explicit SegmentCoupling(std::span<const double> p) : next_(p[0]), far_(p[1]), before_(p[2]) {}

    void actuation(const EffectContext& /*context*/, Actuation& act) override {
        Vec2 before = Vec2::Zero();
        for (std::size_t i = 0; i < act.segments.size(); ++i) {
            const Vec2 own = act.segments[i].bend_rad;  // those that follow still hold their commands
            Vec2& bend = act.segments[i].bend_rad;
            bend += before_ * before;
            if (i + 1 < act.segments.size()) bend += next_ * act.segments[i + 1].bend_rad;
            if (i + 2 < act.segments.size()) bend += far_ * act.segments[i + 2].bend_rad;
            before = own;
        }
    }

private:
    double next_, far_, before_;
};

}  // namespace

EffectInfo segment_coupling_effect() {
    return {
        .name = "segment_coupling",
        .doc = "bending one segment bends its neighbours: cables run through the segments before their own",
        .source = "camarillo2009",
        .hooks = hook_actuation,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip"},
        .parameters = {{"from_next", "1", 0.15, -1.5, 1.5, "part of the next segment's bend that a segment takes"},
                       {"from_far", "1", 0.0, -1.5, 1.5, "the same from the segment after the next"},
                       {"from_before", "1", 0.0, -1.5, 1.5, "the same from the segment before"}},
        .strengths = {"from_next", "from_far", "from_before"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<SegmentCoupling>(p);
        },
    };
}

}  // namespace cathlab
