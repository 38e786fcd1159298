// The tip of the steerable part is not where its drive puts it while something presses on it: it yields by a length a
// force, as the end of an elastic cantilever does, compliance = L^3 / (3 EI) of the whole steerable part where nothing
// else gives [gere2008].
#include "effects/effect.h"

namespace cathlab {
namespace {

class TipCompliance final : public Effect {
public:
    explicit TipCompliance(double mm_per_n) : mm_per_n_(mm_per_n) {}
    void actuation(const EffectContext& /*context*/, Actuation& act) override {
        act.tip_compliance_mm_per_n += mm_per_n_;
    }

private:
    double mm_per_n_;
};

}  // namespace

EffectInfo tip_compliance_effect() {
    return {
        .name = "tip_compliance",
        .doc = "the steerable tip yields to what presses on it",
        .source = "gere2008",
        .hooks = hook_actuation,
        .for_tests = false,
        .applies_to = {"wall-contact"},
        .parameters = {{"compliance_mm_per_n", "mm/N", 5.0, 0.0, 50.0, "way of the tip under a force on it"}},
        .strengths = {"compliance_mm_per_n"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<TipCompliance>(p[0]);
        },
    };
}

}  // namespace cathlab
