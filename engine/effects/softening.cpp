// A wall that was stretched further before is softer (Mullins): the stress of the elastic law is taken times
//     eta = 1 - share erf((W_max - W) / (width W_max))
// with W the energy that the law stores now and W_max the most that it ever stored here (Ogden and Roxburgh's
// pseudo-elasticity [ogden1999], 1/r = share, m = 0).  On the way up for the first time eta = 1.
#include <algorithm>
#include <cmath>

#include "core/deterministic_math.h"
#include "effects/effect.h"

namespace cathlab {
namespace {

/// The error function for x >= 0, to 1.5e-7 [abramowitz1964, 7.1.26].
double error_function(double x) {
    const double t = 1.0 / (1.0 + 0.3275911 * x);
    const double series =
        t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429))));
    return x > 0.0 ? 1.0 - series * det::exp(-x * x) : 0.0;
}

class Softening final : public Effect {
public:
    Softening(double share, double width) : share_(share), width_(width) {}

    void points(std::size_t count) override { most_.resize(count, 0.0); }
    void stress(const EffectContext& /*context*/, MembranePoint& point) override {
        const double most = most_[point.index];
        if (!(most > point.energy_kpa)) return;
        point.stress *= 1.0 - share_ * error_function((most - point.energy_kpa) / (width_ * most));
    }
    void remember(const EffectContext& /*context*/, const MembranePoint& point) override {
        most_[point.index] = std::max(most_[point.index], point.energy_kpa);
    }
    void visit(Archive& archive) override { archive.field("most_kpa", most_); }

private:
    double share_, width_;
    std::vector<double> most_;  // (points) W_max, kPa
};

}  // namespace

EffectInfo softening_effect() {
    return {
        .name = "softening",
        .doc = "a wall that was stretched further before is softer (Mullins)",
        .source = "ogden1999",
        .hooks = hook_membrane,
        .for_tests = false,
        .applies_to = {"wall-tension", "wall-contact"},
        .parameters = {{"share", "1", 0.3, 0.0, 0.9, "of its stress that it loses far below what it has borne"},
                       {"width", "1", 0.5, 0.05, 5.0, "part of the largest energy within which it loses it"}},
        .strengths = {"share"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<Softening>(p[0], p[1]);
        },
        .elastic_wall = true,
    };
}

}  // namespace cathlab
