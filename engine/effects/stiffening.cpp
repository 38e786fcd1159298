// Collagen: crimped at rest, pulled straight as the wall is stretched, so that its tangent modulus rises.  The law is
// that of softbody/fibres.h.
#include "effects/effect.h"

namespace cathlab {
namespace {

class Stiffening final : public Effect {
public:
    explicit Stiffening(const Fibres& fibres) : fibres_(fibres) {}
    void fibres(const EffectContext& /*context*/, Fibres& fibres) override { fibres = fibres_; }

private:
    Fibres fibres_;
};

}  // namespace

EffectInfo stiffening_effect() {
    return {
        .name = "stiffening",
        .doc = "collagen fibres engage: the wall stiffens as it is stretched",
        .source = "gasser2006",
        .hooks = hook_material,
        .for_tests = false,
        .applies_to = {"wall-tension", "wall-contact"},
        .parameters = {{"fibre_kpa", "kPa", 20.0, 0.0, 1e5, "k1 of each of the two families; 0 = none"},
                       {"exponent", "1", 1.0, 0.01, 1000.0, "k2: how steeply they stiffen"},
                       {"angle_deg", "deg", 7.0, 0.0, 90.0, "of the families, from the vessel's circumference"},
                       {"dispersion", "1", 0.0, 0.0, 0.5, "kappa: 0 = all along the angle, 1/2 = every way alike"},
                       {"onset", "1", 0.0, 0.0, 2.0, "strain H : C - 1 at which the crimp is pulled out"}},
        .strengths = {"fibre_kpa"},
        .meant_ends = {"dispersion"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<Stiffening>(Fibres{p[0], p[1], p[2], p[3], p[4]});
        },
        .elastic_wall = true,
    };
}

}  // namespace cathlab
