#include "rod/chain_rows.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace cathlab {
namespace {

constexpr double creep_mm_s = 0.5;        // speed below which friction is a stiff viscous force
constexpr int rubbing_passes = 4;         // passes in which friction may grow or turn
constexpr int engaging_passes = 12;       // passes in which rows may engage
constexpr int last_rubbing_pass = 30;     // a row that still leaves its cone then loses its friction
constexpr double slide_tolerance = 0.05;  // of the cone: how far a sliding row's force may be from the law's
constexpr double inside_cone = 0.99;      // aim of a sliding row, so that a small loss of normal force leaves it legal
constexpr double well_inside_cone = 0.9;  // the same when passes run out
constexpr double cone_tolerance = 1e-9;   // of the cone's half width

Vec3 across(const Vec3& v, const Vec3& normal) {
    return v - normal * normal.dot(v);
}

void check_row(const ChainRow& row) {
    CATHLAB_CHECK(row.link >= 0, "a chain row names no link");
    CATHLAB_CHECK(std::isfinite(row.compliance) && row.compliance >= 1e-12, "a chain row's compliance must be > 0");
    const double sum = row.arm.squaredNorm() + row.normal.squaredNorm() + std::fabs(row.gap) +
                       std::fabs(row.multiplier) + row.slip.squaredNorm() + row.tangent_force.squaredNorm() +
                       std::fabs(row.friction);
    CATHLAB_CHECK(std::isfinite(sum), "a chain row is not finite");
    CATHLAB_CHECK(std::fabs(row.normal.squaredNorm() - 1.0) < 1e-6, "a chain row's normal must be a unit vector");
}

}  // namespace

void ChainRows::set_stick(Work& w, double load) const {
    const double k = w.row.friction * load / rest_slip_;
    w.rub = Rub::stick;
    w.stick = k / (1.0 + k * w.row.compliance);
    w.stick_load = load;
}

// A row that comes in sliding goes on sliding.
void ChainRows::set_rub(Work& w, double load) const {
    const Vec3 slip = across(w.row.slip, w.row.normal);
    const double size = slip.norm();
    if (size <= 2.0 * rest_slip_ || slip.dot(w.row.tangent_force) >= 0.0) {
        set_stick(w, load);
        return;
    }
    w.rub = Rub::slide;
    w.slide = slip * (-inside_cone * w.row.friction * load / size);
}

void ChainRows::begin(std::span<const ChainRow> rows, std::size_t free_links, double h) {
    free_links_ = free_links;
    rest_slip_ = creep_mm_s * h;
    work_.assign(rows.size(), Work{});
    start_.assign(free_links + 2, 0);
    for (std::size_t r = 0; r < rows.size(); ++r) {
        check_row(rows[r]);
        Work& w = work_[r];
        w.row = rows[r];
        w.jacobian << w.row.normal, w.row.arm.cross(w.row.normal);
        const double first = w.row.multiplier - w.row.gap / w.row.compliance;
        w.active = w.row.bilateral || first > 0.0;
        const double load = std::max(0.0, w.row.multiplier);
        if (w.active && w.row.friction > 0.0 && load > 0.0) set_rub(w, load);
        start_[std::min(static_cast<std::size_t>(w.row.link), free_links) + 1] += 1;
    }
    for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
    order_.resize(rows.size());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (std::size_t r = 0; r < rows.size(); ++r)
        order_[next[std::min(static_cast<std::size_t>(work_[r].row.link), free_links)]++] = r;
}

void ChainRows::add_to(std::size_t link, Mat6& diagonal, Vec6& right) const {
    for (std::size_t k = start_[link]; k < start_[link + 1]; ++k) {
        const Work& w = work_[order_[k]];
        if (!w.active) continue;
        const double stiffness = 1.0 / w.row.compliance;
        diagonal += (stiffness * w.jacobian) * w.jacobian.transpose();
        right += w.jacobian * (w.row.multiplier - w.row.gap * stiffness);
        const Vec3& arm = w.row.arm;
        if (w.rub == Rub::slide) {
            right.head<3>() += w.slide;
            right.tail<3>() += arm.cross(w.slide);
        } else if (w.rub == Rub::stick) {
            // B = [P, P [-arm]x]: P (dx + dtheta x arm)
            Mat3 hat;
            hat << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
            Eigen::Matrix<double, 3, 6> b;
            const Mat3 p = Mat3::Identity() - w.row.normal * w.row.normal.transpose();
            b << p, p * hat;
            const Vec3 now = across(w.row.slip, w.row.normal) - w.row.compliance * w.row.tangent_force;
            diagonal += w.stick * b.transpose() * b;
            right -= w.stick * b.transpose() * now;
        }
    }
}

bool ChainRows::update_normal(Work& w, const Vec6& d, bool may_engage) const {
    const double trial = w.row.multiplier - (w.row.gap + w.jacobian.dot(d)) / w.row.compliance;
    if (w.active) {
        w.multiplier = trial;
        if (w.row.bilateral || trial >= 0.0) return false;
        w.active = false;
        w.multiplier = 0.0;
        return true;
    }
    w.multiplier = 0.0;
    if (!may_engage || trial <= 1e-9) return false;
    w.active = true;
    w.multiplier = trial;  // an estimate, for the friction of the next pass
    return true;
}

bool ChainRows::update_friction(Work& w, const Vec6& d, int pass) const {
    w.tangent = Vec3::Zero();
    if (!w.active || w.row.friction <= 0.0) {
        w.rub = Rub::none;
        return false;
    }
    const bool free_pass = pass < rubbing_passes;
    const double cone = w.row.friction * std::fabs(w.multiplier);
    const double c = w.row.compliance;
    const Vec3 moved = across(d.head<3>() + d.tail<3>().cross(w.row.arm), w.row.normal);
    const Vec3 slip_before = across(w.row.slip, w.row.normal) + moved - c * w.row.tangent_force;  // s' - c f'
    if (w.rub == Rub::none) {
        if (!free_pass || cone <= 0.0) return false;
        const double speed = slip_before.norm();
        if (speed > 2.0 * (rest_slip_ + c * cone)) {
            w.rub = Rub::slide;
            w.slide = slip_before * (-inside_cone * cone / speed);
        } else {
            set_stick(w, std::fabs(w.multiplier));
        }
        return true;
    }
    w.tangent = w.rub == Rub::stick ? Vec3(-w.stick * slip_before) : w.slide;
    const double size = w.tangent.norm();
    const Vec3 slip = slip_before + c * w.tangent;
    if (free_pass && w.rub == Rub::slide) {
        // Law at the slip found: back to sticking where it turned round or nearly stopped.
        const double speed = slip.norm();
        if (speed < rest_slip_ || slip.dot(w.tangent) >= 0.0) {
            set_stick(w, std::fabs(w.multiplier));
            return true;
        }
        const Vec3 wanted = slip * (-cone / speed);
        if ((wanted - w.tangent).norm() <= slide_tolerance * cone && size <= cone) return false;
        w.slide = inside_cone * wanted;
        return true;
    }
    if (size > cone * (1.0 + cone_tolerance)) {
        const double keep = pass < last_rubbing_pass ? (free_pass ? inside_cone : well_inside_cone) * cone / size : 0.0;
        w.slide = w.tangent * keep;
        w.rub = Rub::slide;
        return true;
    }
    if (free_pass && std::fabs(w.multiplier) > 2.0 * w.stick_load) {
        set_stick(w, std::fabs(w.multiplier));
        return true;
    }
    return false;
}

std::size_t ChainRows::update(const std::vector<Vec6>& solution, int pass) {
    std::size_t first = free_links_;
    for (std::size_t i = 0; i <= free_links_; ++i) {
        const Vec6 d = i < free_links_ ? solution[i] : Vec6::Zero().eval();
        bool changed = false;
        for (std::size_t k = start_[i]; k < start_[i + 1]; ++k) {
            Work& w = work_[order_[k]];
            changed |= update_normal(w, d, pass < engaging_passes);
            changed |= update_friction(w, d, pass);
        }
        if (changed && first == free_links_) first = i;
    }
    return first;
}

void ChainRows::end(std::span<ChainRow> rows) const {
    for (std::size_t r = 0; r < rows.size(); ++r) {
        rows[r].multiplier = work_[r].multiplier;
        rows[r].tangent_force = work_[r].tangent;
    }
}

}  // namespace cathlab
