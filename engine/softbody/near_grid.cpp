#include "softbody/near_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/check.h"

namespace cathlab {

namespace {
constexpr double most_cells = 4e6;
}

NearGrid::NearGrid(std::span<const Vec3> points, double cell_mm) : points_(points), cell_(cell_mm) {
    CATHLAB_CHECK(!points.empty() && cell_mm > 0.0, "a grid needs points and a cell");
    Vec3 high = points.front();
    low_ = points.front();
    for (const Vec3& p : points) {
        low_ = low_.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    diagonal_ = (high - low_).norm();
    const auto count = [&] { return ((high - low_) / cell_ + Vec3::Ones()).prod(); };
    while (count() > most_cells) cell_ *= 1.5;
    cells_ = ((high - low_) / cell_).array().floor().cast<int>() + 1;
    first_.assign(row(0, 0, cells_.z()) + 1, 0);
    std::vector<std::size_t> cell(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector3i c = cell_of(points[i]);
        cell[i] = row(c.x(), c.y(), c.z());
        ++first_[cell[i] + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<Index> next(first_.begin(), first_.end() - 1);
    order_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        order_[static_cast<std::size_t>(next[cell[i]]++)] = static_cast<Index>(i);
}

Eigen::Vector3i NearGrid::cell_of(const Vec3& p) const {
    Eigen::Vector3i c;
    for (int k = 0; k < 3; ++k)
        c[k] =
            static_cast<int>(std::clamp(std::floor((p[k] - low_[k]) / cell_), 0.0, static_cast<double>(cells_[k] - 1)));
    return c;
}

std::size_t NearGrid::row(int x, int y, int z) const {
    const Eigen::Matrix<std::size_t, 3, 1> size = cells_.cast<std::size_t>();
    return (static_cast<std::size_t>(z) * size.y() + static_cast<std::size_t>(y)) * size.x() +
           static_cast<std::size_t>(x);
}

const std::vector<std::pair<double, Index>>& NearGrid::within(const Vec3& p, double radius) {
    found_.clear();
    const Eigen::Vector3i a = cell_of(p - Vec3::Constant(radius)), b = cell_of(p + Vec3::Constant(radius));
    for (int z = a.z(); z <= b.z(); ++z)
        for (int y = a.y(); y <= b.y(); ++y)
            for (int x = a.x(); x <= b.x(); ++x) {
                const auto c = row(x, y, z);
                for (Index k = first_[c]; k < first_[c + 1]; ++k) {
                    const Index i = order_[static_cast<std::size_t>(k)];
                    const double d2 = (points_[static_cast<std::size_t>(i)] - p).squaredNorm();
                    if (d2 <= radius * radius) found_.emplace_back(d2, i);
                }
            }
    std::sort(found_.begin(), found_.end());
    return found_;
}

const std::vector<std::pair<double, Index>>& NearGrid::nearest(const Vec3& p, std::size_t count) {
    const double outside = (p - p.cwiseMax(low_).cwiseMin(low_ + Vec3::Constant(diagonal_))).norm();
    for (double radius = 2.0 * cell_;; radius *= 2.0) {
        within(p, radius);
        if (found_.size() >= std::min(count, points_.size()) || radius > outside + 3.0 * diagonal_ + cell_)
            return found_;
    }
}

}  // namespace cathlab
