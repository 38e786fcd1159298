// Kind tendon-tip: segments of constant curvature, each bent by its tendons; angles, gains, rest bends and the marker's
// place are fitted.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "catheter/shape.h"
#include "core/errors.h"
#include "core/units.h"
#include "explain/rigs.h"

namespace cathlab {
namespace {

constexpr std::size_t numbers_a_segment = 4;  // angle, gain, rest bend x and y

class TendonRig final : public Rig {
public:
    TendonRig(const Dataset& data, const Split& split) : Rig(data, split) {
        hooks_ = hook_actuation | hook_drive | hook_measure;
        const TendonTipSetup& setup = data.tendons;
        double most = 0.0;
        spec_.segments.clear();
        for (const TendonSegmentSetup& s : setup.segments) {
            spec_.segments.push_back({s.name, s.length_mm, 180.0, 1.0});
            names_.push_back(s.name);
            for (const std::size_t c : s.columns)
                for (const double v : data.columns[c].values) most = std::max(most, std::fabs(v));
        }
        if (!(most > 0.0)) throw UserError(data.folder + ": no tendon was ever pulled; there is nothing to fit");
        for (const DataColumn* column : measured_) axis_.push_back(column->quantity.back() - 'x');
        for (std::size_t k = 0; k < setup.segments.size(); ++k) add_sums(k);
        find_start();
    }

    std::vector<Bound> bounds() const override {
        std::vector<Bound> out;
        for (const std::string& name : names_) {
            out.push_back({-360.0, 360.0, name + "_first_tendon_deg"});
            out.push_back({0.0, 4.0, name + "_gain"});
            out.push_back({-60.0, 60.0, name + "_rest_x_deg"});
            out.push_back({-60.0, 60.0, name + "_rest_y_deg"});
        }
        for (const char* name : {"marker_x_mm", "marker_y_mm", "marker_z_mm"}) out.push_back({-60.0, 60.0, name});
        return out;
    }
    std::vector<double> start() const override { return start_; }

    Columns residual(std::span<const double> base, std::span<const EffectTrial> trials) const override {
        Columns out;
        for (const DataColumn* column : measured_) out.push_back(column->values);
        RigEffects effects(trials);
        const bool actuated = effects.uses(hook_actuation), driven = effects.uses(hook_drive);
        const bool read = effects.uses(hook_measure);
        const std::size_t n = spec_.segments.size();
        const Vec3 marker(base[n * numbers_a_segment], base[n * numbers_a_segment + 1],
                          base[n * numbers_a_segment + 2]);
        Actuation act;
        prepare(act, base);
        std::vector<Vec2> first;  // (segments) gain times the direction of the first tendon
        for (std::size_t k = 0; k < n; ++k) {
            const double* number = &base[k * numbers_a_segment];
            first.push_back(number[1] * Vec2(std::cos(number[0] * units::deg), std::sin(number[0] * units::deg)));
        }
        for (std::size_t i = 0; i < data_.rows(); ++i) {
            if (i == 0 || data_.run[i] != data_.run[i - 1]) effects.begin_run(data_.run[i]);
            effects.next_row(data_.time_s[i]);
            pull(act, base, first, i, actuated);
            if (actuated) effects.actuation(act);
            Pose end;
            for (std::size_t k = 0; k < n; ++k)
                end = segment_end(end, act.segments[k].length_mm, act.segments[k].bend_rad, act.segments[k].taper);
            Vec3 tip = end.to_world(marker);
            if (driven) tip += effects.drive().support_displacement[0];
            if (read) tip = effects.read_tip(tip);
            for (std::size_t c = 0; c < out.size(); ++c) out[c][i] -= tip[axis_[c]];
        }
        return out;
    }

    NamedNumbers parameters(std::span<const double> base, std::span<const EffectTrial>) const override {
        NamedNumbers out;
        const auto named = bounds();
        for (std::size_t k = 0; k < named.size(); ++k) out.emplace_back(named[k].name, base[k]);
        return out;
    }

    std::string why_not(const EffectInfo& effect) const override {
        if (effect.name == "gravity_sag") return "the data do not say where down is";
        return Rig::why_not(effect);
    }

    bool takes_up(const EffectInfo& effect, std::string_view key) const override {
        return effect.name == "registration" && key == "turn_z_deg";  // the angles of the first tendons
    }

private:
    void prepare(Actuation& act, std::span<const double> base) const {
        act.segments.resize(spec_.segments.size());
        for (std::size_t k = 0; k < act.segments.size(); ++k) {
            ActuatedSegment& s = act.segments[k];
            s.length_mm = spec_.segments[k].length_mm;
            s.tendon_radius_mm = data_.tendons.tendon_radius_mm;
            const std::size_t n = data_.tendons.segments[k].columns.size();
            s.tendon_mm.assign(n, 0.0);
            for (std::size_t j = 0; j < n; ++j)
                s.tendon_rad.push_back(base[k * numbers_a_segment] * units::deg +
                                       2.0 * units::pi * static_cast<double>(j) / static_cast<double>(n));
        }
    }

    /// Ideal tendons: the bend whose arc takes in, in the least squares of all of them, what each pulls,
    /// b = 2 gain / (n r) sum_j l_j e_j, and the rest bend.
    void pull(Actuation& act, std::span<const double> base, std::span<const Vec2> first, std::size_t row,
              bool whole) const {
        for (std::size_t k = 0; k < act.segments.size(); ++k) {
            ActuatedSegment& s = act.segments[k];
            const double* number = &base[k * numbers_a_segment];
            const Vec2 &sum = sum_[k][row], &e = first[k];
            s.taper = 0.0;
            s.bend_rad = Vec2(e.x() * sum.x() - e.y() * sum.y(), e.y() * sum.x() + e.x() * sum.y()) +
                         units::deg * Vec2(number[2], number[3]);
            if (!whole) continue;
            const auto& columns = data_.tendons.segments[k].columns;
            for (std::size_t j = 0; j < columns.size(); ++j)
                s.tendon_mm[j] = number[1] * data_.columns[columns[j]].values[row];
        }
    }

    /// sum_: 2 / (n r) sum_j l_j e_j with the first tendon at angle 0.
    void add_sums(std::size_t segment) {
        const auto& columns = data_.tendons.segments[segment].columns;
        const auto n = static_cast<double>(columns.size());
        auto& sums = sum_.emplace_back(data_.rows(), Vec2::Zero());
        for (std::size_t j = 0; j < columns.size(); ++j) {
            const double place = 2.0 * units::pi * static_cast<double>(j) / n;
            const Vec2 e = 2.0 / (n * data_.tendons.tendon_radius_mm) * Vec2(std::cos(place), std::sin(place));
            for (std::size_t i = 0; i < data_.rows(); ++i) sums[i] += data_.columns[columns[j]].values[i] * e;
        }
    }

    /// For small bends the tip goes sideways by the lever of each segment times its bend, which is linear: a regression
    /// gives angle and gain of each segment.
    void find_start() {
        const std::size_t n = spec_.segments.size();
        const auto width = static_cast<Eigen::Index>(2 * n + 2);
        Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(width, width);
        Eigen::VectorXd right = Eigen::VectorXd::Zero(width);
        const DataColumn *x = data_.find("tip_x"), *y = data_.find("tip_y"), *z = data_.find("tip_z");
        double rows = 0.0, z_most = -1e300;
        for (std::size_t i = 0; i < data_.rows(); ++i) {
            if (split_.held_out[i] != 0 || std::isnan(x->values[i]) || std::isnan(y->values[i])) continue;
            // tip = sum_k lever_k (a_k + i b_k) m_k + offset, as complex numbers
            Eigen::VectorXd for_x = Eigen::VectorXd::Zero(width), for_y = Eigen::VectorXd::Zero(width);
            for (std::size_t k = 0; k < n; ++k) {
                const Vec2& m = sum_[k][i];
                const auto at = static_cast<Eigen::Index>(2 * k);
                for_x[at] = m.x();
                for_x[at + 1] = -m.y();
                for_y[at] = m.y();
                for_y[at + 1] = m.x();
            }
            for_x[width - 2] = 1.0;
            for_y[width - 1] = 1.0;
            normal += for_x * for_x.transpose() + for_y * for_y.transpose();
            right += x->values[i] * for_x + y->values[i] * for_y;
            if (!std::isnan(z->values[i])) {
                z_most = std::max(z_most, z->values[i]);
                rows += 1.0;
            }
        }
        normal.diagonal().array() += 1e-9 * (1.0 + normal.trace());
        const Eigen::VectorXd found = normal.ldlt().solve(right);
        double beyond = 0.0, all = 0.0;
        for (const CatheterSegment& s : spec_.segments) all += s.length_mm;
        std::vector<double> levers(n);
        for (std::size_t k = n; k-- > 0;) {
            levers[k] = beyond + 0.5 * spec_.segments[k].length_mm;
            beyond += spec_.segments[k].length_mm;
        }
        for (std::size_t k = 0; k < n; ++k) {
            const double a = found[static_cast<Eigen::Index>(2 * k)], b = found[static_cast<Eigen::Index>(2 * k + 1)];
            const double size = std::hypot(a, b) / levers[k];
            start_.push_back(size > 1e-6 ? std::atan2(b, a) / units::deg : 0.0);
            start_.push_back(std::clamp(size, 0.05, 2.0));
            start_.push_back(0.0);
            start_.push_back(0.0);
        }
        start_.push_back(std::clamp(found[width - 2], -50.0, 50.0));
        start_.push_back(std::clamp(found[width - 1], -50.0, 50.0));
        start_.push_back(rows > 0.0 ? std::clamp(z_most - all, -50.0, 50.0) : 0.0);
    }

    CatheterSpec spec_;
    std::vector<std::string> names_;
    std::vector<int> axis_;
    std::vector<double> start_;
    std::vector<std::vector<Vec2>> sum_;  // (segments x rows) bends per gain
};

}  // namespace

std::unique_ptr<Rig> make_tendon_rig(const Dataset& data, const Split& split) {
    return std::make_unique<TendonRig>(data, split);
}

}  // namespace cathlab
