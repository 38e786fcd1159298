// Kind heart-motion: one periodic beat in each measured coordinate and a rest position a run, both fitted.
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/units.h"
#include "explain/beat_clock.h"
#include "explain/linear_part.h"
#include "explain/rigs.h"

namespace cathlab {
namespace {

constexpr Eigen::Index most_harmonics = 10;
constexpr double rows_a_number = 10.0;  // training rows wanted for each free number of the beat

class HeartRig final : public Rig {
public:
    HeartRig(const Dataset& data, const Split& split) : Rig(data, split), clock_(data) {
        hooks_ = hook_drive | hook_measure;
        const auto train = static_cast<double>(std::count(split.held_out.begin(), split.held_out.end(), 0));
        const auto runs = static_cast<double>(data.run_names.size());
        if (clock_.recorded())
            harmonics_ = std::clamp(static_cast<Eigen::Index>((train / rows_a_number - runs) / 2.0), Eigen::Index{1},
                                    most_harmonics);
        axis_ = data.heart.axis.value_or(Vec3::UnitZ());
        for (const DataColumn* column : measured_) {
            auto& known = known_.emplace_back();
            for (std::size_t i = 0; i < data.rows(); ++i)
                known.push_back(split.held_out[i] == 0 && !std::isnan(column->values[i]) ? 1 : 0);
        }
        Columns rest;
        usual_ = factored(beat_and_effects({}, rest).value());
    }

    Columns residual(std::span<const double>, std::span<const EffectTrial> trials) const override {
        Columns out;
        const std::vector<LinearPart> own = solvers(beat_and_effects(trials, out));
        const std::vector<LinearPart>& use = own.empty() ? usual_ : own;
        for (std::size_t c = 0; c < out.size(); ++c) {
            const LinearPart& part = use[std::min(c, use.size() - 1)];
            subtract(part.basis(), part.solve(out[c]), out[c]);
        }
        return out;
    }

    NamedNumbers parameters(std::span<const double>, std::span<const EffectTrial> trials) const override {
        Columns rest;
        const std::vector<LinearPart> own = solvers(beat_and_effects(trials, rest));
        const std::vector<LinearPart>& use = own.empty() ? usual_ : own;
        NamedNumbers out;
        for (std::size_t c = 0; c < rest.size(); ++c) {
            const Eigen::VectorXd found = use[std::min(c, use.size() - 1)].solve(rest[c]);
            const std::string& quantity = measured_[c]->quantity;
            for (std::size_t r = 0; r < data_.run_names.size(); ++r)
                out.emplace_back("rest_" + data_.run_names[r] + "_" + quantity, found[static_cast<Eigen::Index>(r)]);
            const auto runs = static_cast<Eigen::Index>(data_.run_names.size());
            for (Eigen::Index k = 0; k < harmonics_; ++k) {
                const std::string number = std::to_string(k + 1) + "_" + quantity;
                out.emplace_back("beat_cos_" + number, found[runs + 2 * k]);
                out.emplace_back("beat_sin_" + number, found[runs + 2 * k + 1]);
            }
        }
        return out;
    }

    bool places_differ() const override { return data_.run_names.size() > 1; }

    std::vector<std::string> notes() const override {
        if (clock_.dropped() == 0) return {};
        return {std::to_string(clock_.dropped()) +
                " of the recorded triggers fall within a beat of the others' rhythm and were taken for false"};
    }

private:
    /// One factorisation where all columns know the same rows, else one a column.
    std::vector<LinearPart> factored(const Basis& basis) const {
        std::vector<LinearPart> out;
        const bool alike =
            std::all_of(known_.begin(), known_.end(), [&](const auto& known) { return known == known_[0]; });
        for (std::size_t c = 0; c < (alike ? 1 : known_.size()); ++c) out.emplace_back(basis, known_[c]);
        return out;
    }
    std::vector<LinearPart> solvers(const std::optional<Basis>& basis) const {
        return basis ? factored(*basis) : std::vector<LinearPart>{};
    }

    /// The basis of the beat as the effects leave it (nothing where they leave it as it is and that is known already),
    /// and in `rest` the measurements less what the effects add.  The beat goes from where the heart stands at its
    /// onset: scale (B(phase) - B(0)), the engine's own convention.
    std::optional<Basis> beat_and_effects(std::span<const EffectTrial> trials, Columns& rest) const {
        for (const DataColumn* column : measured_) rest.push_back(column->values);
        RigEffects effects(trials);
        const bool driven = effects.uses(hook_drive), read = effects.uses(hook_measure);
        const auto runs = static_cast<Eigen::Index>(data_.run_names.size());
        double ahead = 0.0;  // of the recorded beats, in beats
        std::vector<BeatPlace> places;
        bool as_usual = !usual_.empty();
        for (std::size_t i = 0; i < data_.rows(); ++i) {
            if (i == 0 || data_.run[i] != data_.run[i - 1]) {
                effects.begin_run(data_.run[i]);
                ahead = 0.0;
            }
            effects.next_row(data_.time_s[i]);
            const BeatTime beat = clock_.at(i);
            EffectContext& context = effects.context();
            context.heart_phase = beat.phase;
            context.heart_beats = beat.number;
            context.heart_beat_s = beat.usual_s;
            context.heart_interval = beat.interval;
            double scale = 1.0;
            Vec3 moved = Vec3::Zero();
            if (driven) {
                const Drive& drive = effects.drive();
                moved = drive.support_displacement[0] + drive.heart_displacement_mm * axis_;
                scale = drive.heart_amplitude_scale;
                if (beat.usual_s > 0.0) ahead += (drive.heart_rate_scale - 1.0) * context.dt / beat.usual_s;
            }
            if (read) {
                Channels channels;
                channels.catheter_tip_x_mm = moved.x();
                channels.catheter_tip_y_mm = moved.y();
                channels.catheter_tip_z_mm = moved.z();
                channels.annulus_displacement_mm = moved.dot(axis_);
                effects.measure(channels);
                subtract_read(channels, i, rest);
            } else if (driven) {
                for (std::size_t c = 0; c < rest.size(); ++c) rest[c][i] -= component(c, moved);
            }
            as_usual = as_usual && scale == 1.0 && ahead == 0.0;
            places.push_back({beat.phase + ahead, scale});
        }
        if (as_usual) return std::nullopt;
        Basis basis = Basis::Zero(static_cast<Eigen::Index>(data_.rows()), runs + 2 * harmonics_);
        for (Eigen::Index row = 0; row < basis.rows(); ++row) {
            const BeatPlace& place = places[static_cast<std::size_t>(row)];
            basis(row, data_.run[static_cast<std::size_t>(row)]) = 1.0;
            const double angle = 2.0 * units::pi * place.phase;
            const double c1 = std::cos(angle), s1 = std::sin(angle);
            double c = 1.0, s = 0.0;
            for (Eigen::Index k = 0; k < harmonics_; ++k) {
                const double next = c * c1 - s * s1;
                s = s * c1 + c * s1;
                c = next;
                basis(row, runs + 2 * k) = place.scale * (c - 1.0);
                basis(row, runs + 2 * k + 1) = place.scale * s;
            }
        }
        return basis;
    }

    double component(std::size_t column, const Vec3& v) const {
        const std::string& quantity = measured_[column]->quantity;
        return quantity == "displacement" ? v.dot(axis_) : v[quantity[0] - 'x'];
    }
    void subtract_read(const Channels& channels, std::size_t row, Columns& rest) const {
        const Vec3 tip(channels.catheter_tip_x_mm, channels.catheter_tip_y_mm, channels.catheter_tip_z_mm);
        for (std::size_t c = 0; c < rest.size(); ++c)
            rest[c][row] -=
                measured_[c]->quantity == "displacement" ? channels.annulus_displacement_mm : component(c, tip);
    }

    struct BeatPlace {
        double phase, scale;
    };

    BeatClock clock_;
    std::vector<std::vector<std::uint8_t>> known_;  // (columns x rows)
    std::vector<LinearPart> usual_;                 // the beat without effects
    Eigen::Index harmonics_ = 0;
    Vec3 axis_;
};

}  // namespace

std::unique_ptr<Rig> make_heart_rig(const Dataset& data, const Split& split) {
    return std::make_unique<HeartRig>(data, split);
}

}  // namespace cathlab
