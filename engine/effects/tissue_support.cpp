// Tissue around the vessel holds its wall like an elastic foundation: a traction of so much for each mm that the wall
// is moved from where the supports stand [moireau2012].
#include "effects/effect.h"

namespace cathlab {
namespace {

class TissueSupport final : public Effect {
public:
    explicit TissueSupport(double kpa_per_mm) : kpa_per_mm_(kpa_per_mm) {}
    void surroundings(const EffectContext& /*context*/, std::span<double> kpa_per_mm) override {
        for (double& k : kpa_per_mm) k += kpa_per_mm_;
    }

private:
    double kpa_per_mm_;
};

}  // namespace

EffectInfo tissue_support_effect() {
    return {
        .name = "tissue_support",
        .doc = "tissue around the vessel holds its wall like an elastic foundation",
        .source = "moireau2012",
        .hooks = hook_material,
        .for_tests = false,
        .applies_to = {"wall-contact"},  // a strip, a ring or a block has nothing around it
        .parameters = {{"kpa_per_mm", "kPa/mm", 1.0, 0.0, 100.0, "traction for each mm that the wall is moved"}},
        .strengths = {"kpa_per_mm"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<TissueSupport>(p[0]);
        },
    };
}

}  // namespace cathlab
