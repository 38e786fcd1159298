#include "rod/chain_rows.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace cathlab {
namespace {

constexpr double creep_mm_s = 0.5;         // speed below which friction is a stiff viscous force
constexpr int rubbing_passes = 6;          // passes in which friction may grow or turn
constexpr int engaging_passes = 12;        // passes in which rows may engage
constexpr int last_rubbing_pass = 30;      // a row that still leaves its cone then loses its friction
constexpr double slide_tolerance = 0.95;   // of the law's force: less is mended while passes last
constexpr double inside_cone = 0.99;       // of the cone: aim, so that a small loss of normal force leaves a row legal
constexpr double well_inside_cone = 0.95;  // the same when passes run out
constexpr double side_drag_per_mm = 1.5;   // holds for hollows of 1 mm radius and wider
constexpr double cone_tolerance = 1e-9;    // of the cone's half width

Vec3 across(const Vec3& v, const Vec3& normal) {
    return v - normal * normal.dot(v);
}

void check_row(const ChainRow& row) {
    CATHLAB_CHECK(row.link >= 0, "a chain row names no link");
    CATHLAB_CHECK(std::isfinite(row.compliance) && row.compliance >= 1e-12, "a chain row's compliance must be > 0");
    const double sum = row.arm.squaredNorm() + row.normal.squaredNorm() + std::fabs(row.gap) +
                       std::fabs(row.multiplier) + row.slip.squaredNorm() + row.tangent_force.squaredNorm() +
                       row.held.squaredNorm() + std::fabs(row.friction);
    CATHLAB_CHECK(std::isfinite(sum), "a chain row is not finite");
    CATHLAB_CHECK(std::fabs(row.normal.squaredNorm() - 1.0) < 1e-6, "a chain row's normal must be a unit vector");
}

}  // namespace

// z and k of the law |f| = min(k_0, mu load / |s' + z|) |s' + z| at a load and a slip s'.  share: aim, in cones, of
// what slides.
void ChainRows::set_rub(Work& w, double load, const Vec3& slip, double share) const {
    const double cone = w.row.friction * load, most = cone / rest_slip_;
    const Vec3 held = across(w.row.held, w.row.normal);
    const double size = held.norm();
    w.bent = (size > cone ? -rest_slip_ / size : -1.0 / most) * held;
    w.rub = std::min(most, share * cone / std::max((slip + w.bent).norm(), 1e-3 * rest_slip_));
    w.rub_with_wall = w.rub / (1.0 + w.rub * w.row.compliance);
}

void ChainRows::begin(std::span<const ChainRow> rows, std::span<const Vec3> axis, double h) {
    const std::size_t free_links = axis.size();
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
        if (w.active && w.row.friction > 0.0 && load > 0.0) set_rub(w, load, across(w.row.slip, w.row.normal), 1.0);
        const std::size_t link = static_cast<std::size_t>(w.row.link);
        if (link < free_links && w.row.multiplier != 0.0) {
            const Vec3 b = w.row.normal.cross(axis[link]);
            const double size = b.norm();
            if (size > 0.1) {
                w.side << b / size, (axis[link] * axis[link].dot(w.row.arm)).cross(b / size);
                w.side_stiffness = side_drag_per_mm * std::fabs(w.row.multiplier);
            }
        }
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
        if (w.side_stiffness > 0.0) {
            diagonal += (w.side_stiffness * w.side) * w.side.transpose();
            right -= w.side * (w.side_stiffness * w.side.head<3>().dot(w.row.slip));
        }
        if (w.rub > 0.0) {
            // B = [P, P [-arm]x]: P (dx + dtheta x arm)
            Mat3 hat;
            hat << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
            Eigen::Matrix<double, 3, 6> b;
            const Mat3 p = Mat3::Identity() - w.row.normal * w.row.normal.transpose();
            b << p, p * hat;
            const Vec3 now = across(w.row.slip, w.row.normal) + w.bent - w.row.compliance * w.row.tangent_force;
            diagonal += w.rub_with_wall * b.transpose() * b;
            right -= w.rub_with_wall * b.transpose() * now;
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
        w.rub = 0.0;
        return false;
    }
    const bool may_grow = pass < rubbing_passes;
    const double load = std::fabs(w.multiplier), cone = w.row.friction * load;
    const Vec3 moved = across(d.head<3>() + d.tail<3>().cross(w.row.arm), w.row.normal);
    const Vec3 without = across(w.row.slip, w.row.normal) + moved - w.row.compliance * w.row.tangent_force;
    if (w.rub <= 0.0) {
        if (!may_grow || cone <= 0.0) return false;
        set_rub(w, load, without, inside_cone);
        return true;
    }
    w.tangent = -w.rub_with_wall * (without + w.bent);
    const double force = w.tangent.norm(), stretch = force / w.rub;  // |s' + z|
    const Vec3 slip = -w.tangent / w.rub - w.bent;
    if (force > cone * (1.0 + cone_tolerance)) {
        if (pass >= last_rubbing_pass) {
            w.rub = 0.0;
        } else {
            set_rub(w, load, slip, may_grow ? inside_cone : well_inside_cone);
        }
        return true;
    }
    if (!may_grow || force >= slide_tolerance * cone * std::min(1.0, stretch / rest_slip_)) return false;
    set_rub(w, load, slip, inside_cone);
    return true;
}

bool ChainRows::update_rows(std::size_t place, const Vec6& d, int pass) {
    bool changed = false;
    for (std::size_t k = start_[place]; k < start_[place + 1]; ++k) {
        Work& w = work_[order_[k]];
        changed |= update_normal(w, d, pass < engaging_passes);
        changed |= update_friction(w, d, pass);
    }
    return changed;
}

bool ChainRows::update(std::size_t link, const Vec6& moved, int pass) {
    return update_rows(link, moved, pass);
}

void ChainRows::update_held(int pass) {
    update_rows(free_links_, Vec6::Zero(), pass);
}

Vec3 ChainRows::side_force(const std::vector<Vec6>& solution) const {
    Vec3 sum = Vec3::Zero();
    for (const Work& w : work_) {
        if (!w.active || w.side_stiffness == 0.0) continue;
        const Vec3 b = w.side.head<3>();
        const double slip = b.dot(w.row.slip) + w.side.dot(solution[static_cast<std::size_t>(w.row.link)]);
        sum -= w.side_stiffness * slip * b;
    }
    return sum;
}

void ChainRows::end(std::span<ChainRow> rows) const {
    for (std::size_t r = 0; r < rows.size(); ++r) {
        rows[r].multiplier = work_[r].multiplier;
        rows[r].tangent_force = work_[r].tangent;
    }
}

}  // namespace cathlab
