// Kind wall-tension: strain = stress / modulus.
#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "explain/linear_part.h"
#include "explain/rigs.h"

namespace cathlab {
namespace {

class TensionRig final : public Rig {
public:
    TensionRig(const Dataset& data, const Split& split) : Rig(data, split) {
        hooks_ = 0;
        const std::vector<double>& stress = data.find("stress")->values;
        basis_ = Basis::Zero(static_cast<Eigen::Index>(data.rows()), 1);
        double most = 0.0;
        for (std::size_t i = 0; i < data.rows(); ++i) {
            basis_(static_cast<Eigen::Index>(i), 0) = std::isnan(stress[i]) ? 0.0 : stress[i];
            if (split.held_out[i] == 0) most = std::max(most, std::fabs(basis_(static_cast<Eigen::Index>(i), 0)));
        }
        if (!(most > 0.0)) throw UserError(data.folder + ": the rows to be fitted hold no 'strain' with any input");
    }

    Columns residual(std::span<const double>, std::span<const EffectTrial>) const override {
        Columns out{measured_[0]->values};
        subtract(basis_, solve_linear(basis_, out[0], split_), out[0]);
        return out;
    }

    NamedNumbers parameters(std::span<const double>, std::span<const EffectTrial>) const override {
        return {{"modulus_kpa", 1.0 / solve_linear(basis_, measured_[0]->values, split_)[0]}};
    }

private:
    Basis basis_;
};

}  // namespace

std::unique_ptr<Rig> make_tension_rig(const Dataset& data, const Split& split) {
    return std::make_unique<TensionRig>(data, split);
}

}  // namespace cathlab
