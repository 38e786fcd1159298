// Under a load that stays the wall goes on giving way, with the logarithm of time, and does not come back
// [fung1993]: Green's strain has a part C that bears no stress and flows towards the elastic one, E,
//     dC/dt = (share / tau) exp(-x) E,   x = C : E / (share E : E),
// so that under a constant E:  C = share ln(1 + t / tau) E.  Integrated exactly for an E that stays as it is.
#include <algorithm>

#include "core/deterministic_math.h"
#include "effects/effect.h"

namespace cathlab {
namespace {

constexpr double most = 40.0;  // of x

class Creep final : public Effect {
public:
    Creep(double share, double tau_s) : share_(share), tau_s_(tau_s) {}

    void points(std::size_t count) override { flowed_.resize(count, Vec3::Zero()); }
    void strain(const EffectContext& /*context*/, MembranePoint& point) override {
        point.c -= 2.0 * flowed_[point.index];
    }
    void remember(const EffectContext& context, const MembranePoint& point) override {
        if (share_ <= 0.0 || context.dt <= 0.0) return;
        const Vec3 elastic(0.5 * (point.c[0] - 1.0), 0.5 * (point.c[1] - 1.0), 0.5 * point.c[2]);
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
    std::vector<Vec3> flowed_;  // (points) C: 11, 22, 12
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
                       {"tau_s", "s", 1.0, 0.01, 1000.0, "time from which it goes with the logarithm"}},
        .strengths = {"share"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<Creep>(p[0], p[1]);
        },
        .elastic_wall = true,
    };
}

}  // namespace cathlab
