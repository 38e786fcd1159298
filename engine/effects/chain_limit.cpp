// A network of chains can only be drawn so far: the elastic stress grows without end as the chains come to their full
// length (Gent's law [gent1996], as a factor on the neo-Hookean stress of a wall that keeps its volume),
//     S = S_e J / (J - (I1 - 3)),   I1 = tr C + 1 / det C,   J = 1 / inverse_limit.
// Near its pole the law goes on as a straight line of the factor in I1.
#include "effects/effect.h"

namespace cathlab {
namespace {

constexpr double nearest = 0.95;  // (I1 - 3) / J

class ChainLimit final : public Effect {
public:
    explicit ChainLimit(double inverse_limit) : inverse_limit_(inverse_limit) {}

    void stress(const EffectContext& /*context*/, MembranePoint& point) override {
        const Vec3& c = point.c;
        const double d = c[0] * c[1] - c[2] * c[2];
        if (!(d > 1e-12)) return;
        const double drawn = inverse_limit_ * (c[0] + c[1] + 1.0 / d - 3.0);
        const double held = drawn < nearest ? drawn : nearest;
        const double at = 1.0 / (1.0 - held), factor = at + at * at * (drawn - held);
        point.stress *= factor;
        point.at_once *= factor * factor;
    }

private:
    double inverse_limit_;
};

}  // namespace

EffectInfo chain_limit_effect() {
    return {
        .name = "chain_limit",
        .doc = "the network's chains come to their full length: rubber stiffens when drawn or pressed far",
        .source = "gent1996",
        .hooks = hook_membrane,
        .for_tests = false,
        .applies_to = {"wall-tension", "wall-contact"},
        .parameters = {{"inverse_limit", "1", 0.02, 0.0, 3.0,
                        "one over I1 - 3 at full length; 0 = chains without end"}},
        .strengths = {"inverse_limit"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<ChainLimit>(p[0]); },
        .elastic_wall = true,
    };
}

}  // namespace cathlab
