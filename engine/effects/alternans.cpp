// Every second beat is stronger, those between weaker: mechanical alternans [surawicz1992].  The excursion of beat n is
// that of the heart's own times 1 + share (-1)^n.
#include "effects/effect.h"

namespace cathlab {
namespace {

class Alternans final : public Effect {
public:
    explicit Alternans(double share) : share_(share) {}
    void drive(const EffectContext& context, Drive& drive) override {
        if (context.heart_beat_s <= 0.0) return;
        drive.heart_amplitude_scale *= 1.0 + (context.heart_beats % 2 == 0 ? share_ : -share_);
    }

private:
    double share_;
};

}  // namespace

EffectInfo alternans_effect() {
    return {
        .name = "alternans",
        .doc = "every second beat is stronger and those between are weaker",
        .source = "surawicz1992",
        .hooks = hook_drive,
        .for_tests = false,
        .applies_to = {"heart-motion"},
        .parameters = {{"share", "1", 0.15, -0.8, 0.8, "part of the excursion that even beats gain and odd ones lose"}},
        .strengths = {"share"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<Alternans>(p[0]); },
    };
}

}  // namespace cathlab
