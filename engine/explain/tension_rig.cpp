// Kind wall-tension: a strip, block or ring of the engine's elastic wall, pulled or pressed one way, in closed form.
// Its modulus is fitted, and how far it goes from the engine's neo-Hookean law to Hooke's: both call one number a
// modulus, and a recording does not say which it means.
#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "explain/rigs.h"
#include "softbody/uniaxial.h"

namespace cathlab {
namespace {

constexpr double poisson = 0.49;   // of arteries and silicones; the format does not say it
constexpr double gauge_mm = 10.0;  // of a specimen whose length the format does not say
constexpr double range = 4.0;      // of ln(modulus), to either side of the first guess
constexpr double no_rest = 10.0;   // strain of a wall that no stretch brings to rest
constexpr int parts_of_a_jump = 16;

class TensionRig final : public Rig {
public:
    TensionRig(const Dataset& data, const Split& split) : Rig(data, split) {
        hooks_ = hook_material | hook_membrane | hook_slip;
        stress_ = &data.find("stress")->values;
        double product = 0.0, square = 0.0;
        for (std::size_t i = 0; i < data.rows(); ++i) {
            const double strain = measured_[0]->values[i], stress = (*stress_)[i];
            if (split.held_out[i] != 0 || std::isnan(strain) || std::isnan(stress)) continue;
            product += strain * stress;
            square += strain * strain;
        }
        if (!(product != 0.0 && square > 0.0))
            throw UserError(data.folder + ": the rows to be fitted hold no 'strain' with any input");
        guess_kpa_ = std::fabs(product) / square;
        one_rate_ = strained_at_one_rate();
    }

    std::vector<Bound> bounds() const override { return {{-range, range, "ln(modulus / guess)"}, {0.0, 1.0, "hooke"}}; }
    std::vector<double> start() const override { return {0.0, 0.5}; }

    Columns residual(std::span<const double> base, std::span<const EffectTrial> trials) const override {
        Columns out{measured_[0]->values};
        RigEffects effects(trials);
        MembraneMaterial material;
        const double modulus_kpa = guess_kpa_ * std::exp(base[0]);
        material.mu_kpa = modulus_kpa / (2.0 * (1.0 + poisson));
        material.thinning = poisson / (1.0 - poisson);
        material.round = Vec2(1.0, 0.0);  // pulled along the circumference
        material.hooke = base[1];
        Fibres fibres;
        const auto law = [&](MembranePoint& point) { effects.membrane(material, fibres, point); };
        Uniaxial at, before;
        double last_stress = 0.0, before_stress = 0.0;
        for (std::size_t i = 0; i < data_.rows(); ++i) {
            if (i == 0 || data_.run[i] != data_.run[i - 1]) {
                effects.begin_run(data_.run[i]);
                effects.points(1);
                fibres = effects.fibres();
                at = before = {};
                last_stress = before_stress = 0.0;
            }
            effects.next_row(data_.time_s[i]);
            const double stress = std::isnan((*stress_)[i]) ? last_stress : (*stress_)[i];
            Uniaxial next = at;
            if (at.slope(0, 0) != 0.0 && last_stress != before_stress) {  // on the line through the last two
                const double part = std::clamp((stress - last_stress) / (last_stress - before_stress), -1.0, 2.0);
                next.along += part * (at.along - before.along);
                next.across += part * (at.across - before.across);
            }
            bool found = uniaxial_rest(law, modulus_kpa, stress, next);
            if (!found) {  // from nothing, in small parts
                next = {};
                found = true;
                for (int k = 1; k <= parts_of_a_jump && found; ++k)
                    found = uniaxial_rest(law, modulus_kpa, stress * k / parts_of_a_jump, next);
            }
            if (!found) {
                out[0][i] -= no_rest;
                continue;
            }
            before = at;
            before_stress = last_stress;
            at = next;
            last_stress = stress;
            MembranePoint point;
            point.c = Vec3(at.along * at.along, at.across * at.across, 0.0);
            law(point);
            effects.remember(point);
            HeldPoint held;
            held.traction = Vec3(stress, 0.0, 0.0);
            effects.slip(held);
            effects.remember_slip(held);
            out[0][i] -= at.along - 1.0 + held.slipped.x() / gauge_mm;
        }
        return out;
    }

    NamedNumbers parameters(std::span<const double> base, std::span<const EffectTrial>) const override {
        return {{"modulus_kpa", guess_kpa_ * std::exp(base[0])}, {"hooke_share", base[1]}};
    }

    bool takes_up(const EffectInfo& effect, std::string_view key) const override {
        // One way of pulling sees of the fibres' directions how many of them lie along it, which the dispersion says.
        return effect.name == "stiffening" && key == "angle_deg";
    }

    std::string why_not(const EffectInfo& effect) const override {
        if (one_rate_ && (effect.name == "viscoelasticity" || effect.name == "creep"))
            return "every specimen is strained at one rate and never let go: what takes time cannot be told from the "
                   "law's own shape; another rate, a hold or an unloading would";
        return Rig::why_not(effect);
    }

private:
    /// Whether strain is time by another name, the same in every recording: what has passed is then a function of where
    /// the specimen is.
    bool strained_at_one_rate() const {
        constexpr double even = 0.02;  // of the rate
        const std::vector<double>& strain = measured_[0]->values;
        double sum = 0.0, squares = 0.0, count = 0.0;
        for (std::size_t i = 1; i < data_.rows(); ++i) {
            if (data_.run[i] != data_.run[i - 1] || std::isnan(strain[i]) || std::isnan(strain[i - 1])) continue;
            const double rate = (strain[i] - strain[i - 1]) / (data_.time_s[i] - data_.time_s[i - 1]);
            sum += rate;
            squares += rate * rate;
            count += 1.0;
        }
        if (count < 2.0) return false;
        const double mean = sum / count;
        return squares / count - mean * mean < even * even * mean * mean;
    }

    const std::vector<double>* stress_;
    double guess_kpa_ = 0.0;
    bool one_rate_ = false;
};

}  // namespace

std::unique_ptr<Rig> make_tension_rig(const Dataset& data, const Split& split) {
    return std::make_unique<TensionRig>(data, split);
}

}  // namespace cathlab
