// A segment does not bend evenly: friction spends the cables' pull on its way, or the wall is stiffer at one end, so
// that the curvature goes in a straight line from one end of it to the other [camarillo2009],
//     kappa(s) = bend / length (1 + taper (2 s / length - 1)).
#include "effects/play.h"

namespace cathlab {
namespace {

class CurvatureTaper final : public Effect {
public:
    explicit CurvatureTaper(std::span<const double> p) : taper_{p[0], p[1], p[2]} {}
    void actuation(const EffectContext& /*context*/, Actuation& act) override {
        const std::size_t n = act.segments.size();
        for (std::size_t i = 0; i < n; ++i) act.segments[i].taper += of_segment(i, n, taper_[0], taper_[1], taper_[2]);
    }

private:
    double taper_[3];
};

}  // namespace

EffectInfo curvature_taper_effect() {
    return {
        .name = "curvature_taper",
        .doc = "a segment bends more at one end than at the other",
        .source = "camarillo2009",
        .hooks = hook_actuation,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip"},
        .parameters = {{"proximal", "1", -0.2, -1.0, 1.0, "of the first segment; -1 = all of the bend at its base"},
                       {"middle", "1", -0.2, -1.0, 1.0, "the same of each segment between first and last"},
                       {"distal", "1", -0.2, -1.0, 1.0, "the same of the last segment"}},
        .strengths = {"proximal", "middle", "distal"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<CurvatureTaper>(p);
        },
    };
}

}  // namespace cathlab
