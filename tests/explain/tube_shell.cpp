#include "explain/tube_shell.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace explain_test {
namespace {

using Eigen::Matrix3d;
using Eigen::VectorXd;

constexpr double pi = std::numbers::pi;
constexpr double near_mm = 2.5, far_mm = 9.0, dense_mm = 11.0, growth = 1.4;  // elements
constexpr double stick_kpa_per_mm = 300.0;
constexpr double still_mn = 2e-3;
constexpr int most_iterations = 60;
constexpr std::size_t points_of_one = 4;  // element

/// Breaks from 0 both ways, near_mm apart within dense_mm and growing beyond, to at least `low` and `high` and scaled
/// to end there.
std::vector<double> graded(double low, double high) {
    const auto side = [](double end) {
        std::vector<double> out;
        double at = 0.5 * near_mm, step = near_mm;
        while (at < end - 0.5 * step) {
            out.push_back(at);
            if (at > dense_mm) step = std::min(far_mm, step * growth);
            at += step;
        }
        out.push_back(at);
        // What is too much or too little is spread over the outer half.
        const double over = out.back() - end, from = std::min(dense_mm, 0.5 * end);
        for (double& b : out)
            if (b > from) b -= over * (b - from) / (out.back() - from);
        out.back() = end;
        return out;
    };
    std::vector<double> out;
    for (const double b : side(-low)) out.insert(out.begin(), -b);
    for (const double b : side(high)) out.push_back(b);
    return out;
}

Vector3d products(const Vector3d& a, const Vector3d& b) {
    return {a.dot(a), b.dot(b), a.dot(b)};
}

}  // namespace

double TubeShell::Splines::knot(int k) const {
    const int last = static_cast<int>(breaks.size()) - 1;
    const double whole = breaks.back() - breaks.front();
    if (k < 0) return closed ? breaks[static_cast<std::size_t>(last + k)] - whole : breaks.front();
    if (k > last) return closed ? breaks[static_cast<std::size_t>(k - last)] + whole : breaks.back();
    return breaks[static_cast<std::size_t>(k)];
}

Matrix3d TubeShell::Splines::at(int span, double x) const {
    const double a = knot(span - 1), b = knot(span), c = knot(span + 1), d = knot(span + 2);
    const double first = 1.0 / ((c - a) * (c - b)), last = 1.0 / ((d - b) * (c - b));
    Matrix3d out;  // a row a spline
    out.row(0) << (c - x) * (c - x) * first, -2.0 * (c - x) * first, 2.0 * first;
    out.row(2) << (x - b) * (x - b) * last, 2.0 * (x - b) * last, 2.0 * last;
    out.row(1) = Eigen::RowVector3d(1.0, 0.0, 0.0) - out.row(0) - out.row(2);
    return out;
}

VectorXd TubeShell::Splines::fit(const std::function<double(double)>& f) const {
    const int n = count(), spans = static_cast<int>(breaks.size()) - 1;
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(n, n);
    VectorXd wanted(n);
    for (int j = 0; j < n; ++j) {
        const double place = 0.5 * (knot(j - 1) + knot(j));
        int span = j - 1;
        if (!closed) span = std::clamp(span, 0, spans - 1);
        const Matrix3d shape = at(span, place);
        for (int k = 0; k < 3; ++k) values(j, (span + k + n) % n) += shape(k, 0);
        wanted[j] = f(place);
    }
    return values.partialPivLu().solve(wanted);
}

TubeShell::TubeShell(const TubeRig& rig, double angle, double z) : rig_(rig), turn_(angle) {
    radius_ = rig.lumen_radius_mm + 0.5 * rig.thickness_mm;
    round_ = {graded(-pi * radius_, pi * radius_), true};
    along_ = {graded(-z, rig.length_mm - z), false};
    for (double& b : along_.breaks) b += z;
    const VectorXd c = round_.fit([&](double u) { return radius_ * std::cos(u / radius_ + turn_); });
    const VectorXd s = round_.fit([&](double u) { return radius_ * std::sin(u / radius_ + turn_); });
    const VectorXd h = along_.fit([](double v) { return v; });
    const int nu = round_.count(), nv = along_.count();
    rest_.resize(3 * nu * nv);
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) rest_.segment<3>(3 * (j * nu + i)) = Vector3d(c[i], s[i], h[j]);
    x_ = rest_;
    const double gauss = std::sqrt(1.0 / 3.0);
    edge_mm2_.assign(static_cast<std::size_t>(nu * nv), 0.0);
    anchor_.assign(static_cast<std::size_t>(nu * nv), Vector3d::Zero());
    for (int a = 0; a + 1 < static_cast<int>(round_.breaks.size()); ++a) {
        const double u0 = round_.knot(a), du = round_.knot(a + 1) - u0;
        for (const double p : {-gauss, gauss}) {
            const Matrix3d shape = round_.at(a, u0 + 0.5 * (1.0 + p) * du);
            for (int k = 0; k < 3; ++k)
                for (const int ring : {0, nv - 1})
                    edge_mm2_[static_cast<std::size_t>(ring * nu + (a + k) % nu)] +=
                        0.5 * du * shape(k, 0) * rig.thickness_mm;
        }
        for (int b = 0; b + 1 < static_cast<int>(along_.breaks.size()); ++b) {
            const double v0 = along_.knot(b), dv = along_.knot(b + 1) - v0;
            for (const double p : {-gauss, gauss})
                for (const double r : {-gauss, gauss}) {
                    Point at = point(a, b, u0 + 0.5 * (1.0 + p) * du, v0 + 0.5 * (1.0 + r) * dv);
                    at.area *= 0.25 * du * dv;
                    for (double& volume : at.volume) volume *= 0.25 * du * dv;
                    points_.push_back(std::move(at));
                }
        }
    }
}

TubeShell::Point TubeShell::point(int span_u, int span_v, double u, double v) const {
    Point p;
    const Matrix3d a = round_.at(span_u, u), b = along_.at(span_v, v);
    const int nu = round_.count();
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
            p.node[static_cast<std::size_t>(3 * j + i)] = (span_v + j) * nu + (span_u + i) % nu;
            p.shape.row(3 * j + i) << a(i, 0) * b(j, 0), a(i, 1) * b(j, 0), a(i, 0) * b(j, 1), a(i, 2) * b(j, 0),
                a(i, 0) * b(j, 2), a(i, 1) * b(j, 1);
        }
    const Local q = local(p, rest_);
    const Vector3d normal = q.col(1).cross(q.col(2));
    p.rest = q.col(0);
    p.area = normal.norm();
    p.metric = products(q.col(1), q.col(2));
    p.bend = q.rightCols<3>().transpose() * normal / p.area;
    for (int k = 0; k < layers; ++k) {
        const double high = (k == 0 ? -1.0 : 1.0) * rig_.thickness_mm / std::sqrt(12.0);
        const Vector3d g = p.metric - 2.0 * high * p.bend;
        // g = L L^T; strains in the frame of the layer at rest are L^-1 e L^-T.
        const double l11 = std::sqrt(g[0]), l21 = g[2] / l11, l22 = std::sqrt(g[1] - l21 * l21);
        const double i11 = 1.0 / l11, i22 = 1.0 / l22, i21 = -l21 * i11 * i22;
        p.into[static_cast<std::size_t>(k)] << i11 * i11, 0.0, 0.0, i21 * i21, i22 * i22, 2.0 * i21 * i22, i11 * i21,
            0.0, i11 * i22;
        p.volume[static_cast<std::size_t>(k)] = l11 * l22 * rig_.thickness_mm / layers;
    }
    return p;
}

TubeShell::Local TubeShell::local(const Point& p, const VectorXd& x) const {
    Local q = Local::Zero();
    for (int k = 0; k < 9; ++k) q += x.segment<3>(3 * p.node[static_cast<std::size_t>(k)]) * p.shape.row(k);
    return q;
}

Vector3d TubeShell::press_at(const Point& p, const Vector3d& place, Matrix3d* stiffness) const {
    const Vector3d off = place - ball_;
    const double radius = rig_.ball_radius_mm + 0.5 * rig_.thickness_mm, distance = off.norm();
    const double depth = radius - distance, k = rig_.bed_kpa_per_mm * p.area;
    if (!(depth > 0.0)) return Vector3d::Zero();
    const Vector3d n = off / distance;
    if (stiffness != nullptr)
        *stiffness += k * (n * n.transpose() - depth / distance * (Matrix3d::Identity() - n * n.transpose()));
    return k * depth * n;
}

TubeShell::Local TubeShell::answer(const Point& p, const Local& q, bool keep) const {
    const Vector3d a1 = q.col(1), a2 = q.col(2), across = a1.cross(a2);
    const double size = across.norm();
    const Vector3d n = across / size, bend = q.rightCols<3>().transpose() * n;
    const Vector3d stretch = 0.5 * (products(a1, a2) - p.metric), turn = bend - p.bend;
    Vector3d pull = Vector3d::Zero(), moment = Vector3d::Zero();
    for (int k = 0; k < layers; ++k) {
        const auto layer = static_cast<std::size_t>(k);
        const double high = (k == 0 ? -1.0 : 1.0) * rig_.thickness_mm / std::sqrt(12.0);
        Vector3d stress = rig_.law(p.into[layer] * (stretch - high * turn), p.memory[layer], keep);
        stress[2] *= 2.0;
        const Vector3d by = p.volume[layer] * p.into[layer].transpose() * stress;
        pull += by;
        moment -= high * by;
    }
    Local out;
    out.col(0).setZero();
    const Vector3d lever = (q.rightCols<3>() * moment - bend.dot(moment) * n) / size;
    out.col(1) = pull[0] * a1 + 0.5 * pull[2] * a2 + a2.cross(lever);
    out.col(2) = pull[1] * a2 + 0.5 * pull[2] * a1 + lever.cross(a1);
    out.rightCols<3>() = n * moment.transpose();
    return out;
}

VectorXd TubeShell::forces(const VectorXd& x, Eigen::SparseMatrix<double>* stiffness) const {
    constexpr double h = 1e-7;
    VectorXd out = VectorXd::Zero(x.size());
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::Matrix<double, 27, 27> block;
    for (std::size_t number = 0; number < points_.size(); ++number) {
        const Point& p = points_[number];
        const Local q = local(p, x), g = answer(p, q, false);
        Matrix3d pressed = Matrix3d::Identity() * rig_.support_kpa_per_mm * p.area;
        const Vector3d push = press_at(p, q.col(0), &pressed);
        const Vector3d held = rig_.support_kpa_per_mm * p.area * (p.rest - q.col(0));
        for (int k = 0; k < 9; ++k)
            out.segment<3>(3 * p.node[static_cast<std::size_t>(k)]) +=
                p.shape(k, 0) * (push + held) - g * p.shape.row(k).transpose();
        if (stiffness == nullptr) continue;
        Eigen::Matrix<double, 18, 18> slope = Eigen::Matrix<double, 18, 18>::Zero();
        slope.topLeftCorner<3, 3>() = pressed;
        for (int m = 3; m < 18; ++m) {
            Local moved = q;
            moved.data()[m] += h;
            const Local change = (answer(p, moved, false) - g) / h;
            slope.col(m) = Eigen::Map<const Eigen::Matrix<double, 18, 1>>(change.data());
        }
        Eigen::Matrix<double, 18, 27> columns = Eigen::Matrix<double, 18, 27>::Zero();
        for (int k = 0; k < 9; ++k)
            for (int m = 0; m < 6; ++m) columns.middleCols<3>(3 * k) += p.shape(k, m) * slope.middleCols<3>(3 * m);
        if (number % points_of_one == 0) block.setZero();
        for (int k = 0; k < 9; ++k)
            for (int m = 0; m < 6; ++m) block.middleRows<3>(3 * k) += p.shape(k, m) * columns.middleRows<3>(3 * m);
        for (int i = 0; i < 27 && (number + 1) % points_of_one == 0; ++i)
            for (int j = 0; j < 27; ++j) {
                const int row = 3 * p.node[static_cast<std::size_t>(i / 3)] + i % 3,
                          column = 3 * p.node[static_cast<std::size_t>(j / 3)] + j % 3;
                if (row >= column) entries.emplace_back(row, column, 0.5 * (block(i, j) + block(j, i)));
            }
    }
    for (std::size_t i = 0; i < edge_mm2_.size(); ++i) {
        if (edge_mm2_[i] == 0.0) continue;
        const auto at = static_cast<Eigen::Index>(3 * i);
        Matrix3d slope = Matrix3d::Identity();
        if (rig_.edge.slides) {
            const Vector3d moved = x.segment<3>(at) - rest_.segment<3>(at);
            Vector3d rub = stick_kpa_per_mm * (moved - anchor_[i]);
            const double trial = rub.norm();
            slope *= rig_.edge.spring_kpa_per_mm;
            if (trial > rig_.edge.threshold_kpa) {
                const Vector3d way = rub / trial;
                rub = rig_.edge.threshold_kpa * way;
                slope +=
                    stick_kpa_per_mm * rig_.edge.threshold_kpa / trial * (Matrix3d::Identity() - way * way.transpose());
            } else {
                slope += stick_kpa_per_mm * Matrix3d::Identity();
            }
            slope *= edge_mm2_[i];
            out.segment<3>(at) -= edge_mm2_[i] * (rig_.edge.spring_kpa_per_mm * moved + rub);
        } else {
            slope *= 1e12;
            out.segment<3>(at).setZero();
        }
        for (int r = 0; r < 3 && stiffness != nullptr; ++r)
            for (int c = 0; c <= r; ++c)
                entries.emplace_back(static_cast<int>(at) + r, static_cast<int>(at) + c, slope(r, c));
    }
    if (stiffness != nullptr) {
        stiffness->resize(x.size(), x.size());
        stiffness->setFromTriplets(entries.begin(), entries.end());
    }
    return out;
}

bool TubeShell::settle() {
    VectorXd force = forces(x_, nullptr);
    double before = 0.0;  // the last step
    for (int round = 0; round < most_iterations; ++round) {
        if (!force.allFinite()) return false;
        if (force.lpNorm<Eigen::Infinity>() < still_mn) return true;
        // Old factors are good while they bring the forces down.
        if (force.norm() > 0.1 * before) {
            Eigen::SparseMatrix<double> stiffness;
            forces(x_, &stiffness);
            if (!analysed_) solver_.analyzePattern(stiffness);
            analysed_ = true;
            solver_.factorize(stiffness);
            if (solver_.info() != Eigen::Success) return false;
        }
        before = force.norm();
        const VectorXd step = solver_.solve(force);
        const double longest = step.lpNorm<Eigen::Infinity>();
        double share = std::min(1.0, 1.0 / longest);
        VectorXd tried, there;
        // Where the forces work against the step at its end it was too far.
        const double work = force.dot(step);
        for (int shortened = 0; shortened < 6; ++shortened) {
            tried = x_ + share * step;
            there = forces(tried, nullptr);
            const double left = there.allFinite() ? there.dot(step) : -work;
            if (left > -0.3 * std::fabs(work)) break;
            share *= std::clamp(work / (work - left), 0.1, 0.7);
        }
        x_.swap(tried);
        force.swap(there);
    }
    return false;
}

Vector3d TubeShell::press(const Vector3d& ball) {
    constexpr double most_mm = 1.0;  // at once
    const Vector3d from = begun_ ? ball_ : ball;
    const VectorXd before = x_;
    bool found = false;
    for (int parts = 1 + static_cast<int>((ball - from).norm() / most_mm); !found && parts < 100; parts *= 4) {
        x_ = before;
        found = true;
        for (int k = 1; k <= parts && found; ++k) {
            ball_ = from + (ball - from) * (static_cast<double>(k) / parts);
            found = settle();
        }
    }
    if (!found) throw std::runtime_error("the made tube comes to no rest");
    begun_ = true;
    Vector3d total = Vector3d::Zero();
    for (const Point& p : points_) {
        const Local q = local(p, x_);
        answer(p, q, true);
        total += press_at(p, q.col(0), nullptr);
    }
    for (std::size_t i = 0; i < edge_mm2_.size() && rig_.edge.slides; ++i) {
        const auto at = static_cast<Eigen::Index>(3 * i);
        const Vector3d off = x_.segment<3>(at) - rest_.segment<3>(at) - anchor_[i];
        const double over = stick_kpa_per_mm * off.norm() - rig_.edge.threshold_kpa;
        if (edge_mm2_[i] > 0.0 && over > 0.0) anchor_[i] += over / stick_kpa_per_mm * off.normalized();
    }
    return total;
}

Vector3d TubeShell::outside(double angle, double z) const {
    double u = std::remainder(angle - turn_, 2.0 * pi) * radius_;
    const auto span_of = [](const Splines& splines, double at) {
        const auto it = std::upper_bound(splines.breaks.begin(), splines.breaks.end(), at);
        return std::clamp(static_cast<int>(it - splines.breaks.begin()) - 1, 0,
                          static_cast<int>(splines.breaks.size()) - 2);
    };
    const Point p = point(span_of(round_, u), span_of(along_, z), u, z);
    const Local q = local(p, x_);
    const Vector3d across = q.col(1).cross(q.col(2));
    // The wall keeps its volume.
    return q.col(0) + 0.5 * rig_.thickness_mm * p.area / across.squaredNorm() * across;
}

}  // namespace explain_test
