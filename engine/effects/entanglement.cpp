// Chains of a rubber are entangled, and loosen as they are drawn: Mooney's second term [mooney1940] beside the elastic
// law, for a wall that keeps its volume,
//     W = share mu / 2 (I2 - 3),   I2 = det C + tr C / det C,   S = 2 dW/dC.
// Its modulus at rest adds to the law's: 1 + share times as much.
#include "effects/effect.h"

namespace cathlab {
namespace {

class Entanglement final : public Effect {
public:
    explicit Entanglement(double share) : share_(share) {}

    void stress(const EffectContext& /*context*/, MembranePoint& point) override {
        const Vec3& c = point.c;
        const double d = c[0] * c[1] - c[2] * c[2];
        if (share_ == 0.0 || !(d > 1e-12)) return;
        const double across = 1.0 - (c[0] + c[1]) / (d * d), along = 1.0 / d;
        point.stress += share_ * point.mu_kpa * Vec3(across * c[1] + along, across * c[0] + along, -across * c[2]);
        point.at_once *= 1.0 + 3.0 * share_ * (d < 1.0 ? 1.0 / d : 1.0);
    }

private:
    double share_;
};

}  // namespace

EffectInfo entanglement_effect() {
    return {
        .name = "entanglement",
        .doc = "entangled chains loosen as they are drawn: Mooney's second term",
        .source = "mooney1940",
        .hooks = hook_membrane,
        .for_tests = false,
        .applies_to = {"wall-tension", "wall-contact"},
        .parameters = {{"share", "1", 0.2, 0.0, 20.0, "of the second term's stiffness at rest over the first's"}},
        .strengths = {"share"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<Entanglement>(p[0]);
        },
        .elastic_wall = true,
    };
}

}  // namespace cathlab
