// The wall resists what is quick more than what is slow: a Maxwell element beside the elastic law (a standard linear
// solid [fung1993]),
//     S = S_e + Q,   dQ/dt + Q / theta = g dS_e/dt,   g = share / (1 - share),   theta = (1 - share) tau,
// so that under a load that comes at once and stays, `share` of the strain comes later, by 1 - exp(-t / tau).  share =
// 1 is Voigt's solid, a dashpot beside the elastic law. solved exactly for an S_e that goes straight from call to call.
// At first Q = 0: the wall has stood there for long.  S is the stress that `measure` says (measure.h): 2 = the second
// Piola-Kirchhoff stress, 1 = by the section at rest, in which Fung wrote his quasi-linear law.
#include <algorithm>

#include "core/deterministic_math.h"
#include "effects/effect.h"
#include "effects/measure.h"

namespace cathlab {
namespace {

constexpr double most = 0.9995;  // share: one beyond cannot be told from Voigt's solid

class Viscoelasticity final : public Effect {
public:
    Viscoelasticity(double share, double tau_s, double measure)
        : share_(std::min(share, most) / (1.0 - std::min(share, most))),
          tau_s_(tau_s * (1.0 - std::min(share, most))),
          measure_(measure) {}

    void points(std::size_t count) override { memory_.resize(count); }
    void stress(const EffectContext& context, MembranePoint& point) override {
        const Memory& m = memory_[point.index];
        if (share_ <= 0.0) return;
        if (!m.started) {
            point.at_once *= 1.0 + share_;
            return;
        }
        double kept = 1.0, at_once = share_;
        relaxation(context.dt, kept, at_once);
        const Vec3 elastic = measure_.stress(point.stress, point.c);
        const Vec3 more = kept * m.over + at_once * (elastic - m.elastic);
        point.stress += measure_.second_piola(more, point.c);
        point.at_once *= 1.0 + at_once;
    }
    void remember(const EffectContext& context, const MembranePoint& point) override {
        Memory& m = memory_[point.index];
        if (share_ <= 0.0) return;
        const Vec3 stress = measure_.stress(point.stress, point.c);
        if (!m.started) {
            m = {stress, Vec3::Zero(), true};
            return;
        }
        double kept = 1.0, at_once = share_;
        relaxation(context.dt, kept, at_once);
        // stress = e + kept over + at_once (e - elastic before), for e.
        const Vec3 elastic = (stress - kept * m.over + at_once * m.elastic) / (1.0 + at_once);
        m.over = stress - elastic;
        m.elastic = elastic;
    }
    void visit(Archive& archive) override {
        for (Memory& m : memory_) {
            archive.field("elastic_kpa", m.elastic);
            archive.field("over_kpa", m.over);
        }
    }

private:
    struct Memory {
        Vec3 elastic = Vec3::Zero(), over = Vec3::Zero();  // S_e and Q, kPa
        bool started = false;
    };
    void relaxation(double dt, double& kept, double& at_once) const {
        const double x = dt / tau_s_;
        if (x < 1e-9) return;
        kept = det::exp(-x);
        at_once = share_ * (1.0 - kept) / x;
    }

    double share_, tau_s_;  // g and theta
    StrainMeasure measure_;
    std::vector<Memory> memory_;  // (points)
};

}  // namespace

EffectInfo viscoelasticity_effect() {
    return {
        .name = "viscoelasticity",
        .doc = "the wall resists what is quick more than what is slow",
        .source = "fung1993",
        .hooks = hook_membrane,
        .for_tests = false,
        .applies_to = {"wall-tension", "wall-contact"},
        .parameters =
            {{"share", "1", 0.3, 0.0, 1.0, "part of the strain that comes later; 1 = none at once"},
             {"tau_s", "s", 1.0, 0.01, 3000.0, "time in which it comes"},
             {"measure", "1", 2.0, 0.0, 2.0,
              "of the stress that relaxes: 2 = second Piola-Kirchhoff's, 1 = by the section at rest, 0 = Hencky's"}},
        .strengths = {"share"},
        .meant_ends = {"measure"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<Viscoelasticity>(p[0], p[1], p[2]);
        },
        .elastic_wall = true,
    };
}

}  // namespace cathlab
