// Under a load that stays the wall goes on giving way, with the logarithm of time, and does not come back
// [fung1993]: its strain has a part F that bears no stress and flows towards the elastic one, E,
//     dF/dt = (share / tau) exp(-x) E,   x = F : E / (share E : E),
// so that under a constant E:  F = share ln(1 + t / tau) E.  Integrated exactly for an E that stays as it is.  Strains
// add in the measure that `measure` says (measure.h), and the stress is the one that works on it.
#include <algorithm>

#include "core/deterministic_math.h"
#include "effects/effect.h"
#include "effects/measure.h"

namespace cathlab {
namespace {

constexpr double most = 40.0;  // of x

class Creep final : public Effect {
public:
    Creep(double share, double tau_s, double measure) : share_(share), tau_s_(tau_s), measure_(measure) {}

    void points(std::size_t count) override { flowed_.resize(count, Vec3::Zero()); }
    void strain(const EffectContext& /*context*/, MembranePoint& point) override {
        if (share_ > 0.0) point.c = measure_.c(measure_.strain(point.c) - flowed_[point.index]);
    }
    void stress(const EffectContext& /*context*/, MembranePoint& point) override {
        if (share_ <= 0.0) return;
        const Vec3 whole = measure_.c(measure_.strain(point.c) + flowed_[point.index]);
        point.stress = measure_.second_piola(measure_.stress(point.stress, point.c), whole);
    }
    void remember(const EffectContext& context, const MembranePoint& point) override {
        if (share_ <= 0.0 || context.dt <= 0.0) return;
        const Vec3 elastic = measure_.strain(point.c);
        const auto dot = [](const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + 2.0 * a[2] * b[2]; };
        const double square = dot(elastic, elastic);
        if (!(square > 1e-16)) return;
        Vec3& flowed = flowed_[point.index];
        const double x = std::clamp(dot(flowed, elastic) / (share_ * square), 0.0, most);
        const double grown = det::log(det::exp(x) + context.dt / tau_s_);
        flowed += share_ * (grown - x) * elastic;
    }
    void visit(Archive& archive) override { archive.field("flowed", flowed_); }

private:
    double share_, tau_s_;
    StrainMeasure measure_;
    std::vector<Vec3> flowed_;  // (points) F: 11, 22, 12
};

}  // namespace

EffectInfo creep_effect() {
    return {
        .name = "creep",
        .doc = "under a load that stays the wall goes on giving way, with the logarithm of time",
        .source = "fung1993",
        .hooks = hook_membrane,
        .for_tests = false,
        .applies_to = {"wall-tension", "wall-contact"},
        .parameters = {{"share", "1", 0.03, 0.0, 0.5, "of the elastic strain that is added in each e-fold of time"},
                       {"tau_s", "s", 1.0, 0.01, 1000.0, "time from which it goes with the logarithm"},
                       {"measure", "1", 2.0, 0.0, 2.0,
                        "of the strain that adds up: 2 = Green's, 1 = by the length at rest, 0 = Hencky's"}},
        .strengths = {"share"},
        .meant_ends = {"measure"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<Creep>(p[0], p[1], p[2]);
        },
        .elastic_wall = true,
    };
}

}  // namespace cathlab
