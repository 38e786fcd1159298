// Nearest particles in space, by a uniform grid.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/types.h"

namespace cathlab {

class NearGrid {
public:
    /// cell_mm: about the distance between points.
    NearGrid(std::span<const Vec3> points, double cell_mm);
    /// Squared distance and index of every point within `radius` of p, ascending.
    const std::vector<std::pair<double, Index>>& within(const Vec3& p, double radius);
    /// At least `count` nearest (or all there are), ascending.
    const std::vector<std::pair<double, Index>>& nearest(const Vec3& p, std::size_t count);

private:
    Eigen::Vector3i cell_of(const Vec3& p) const;
    std::size_t row(int x, int y, int z) const;  ///< of a cell in first_

    std::span<const Vec3> points_;
    double cell_ = 1.0, diagonal_ = 0.0;
    Vec3 low_ = Vec3::Zero();
    Eigen::Vector3i cells_ = Eigen::Vector3i::Ones();
    std::vector<Index> first_, order_;
    std::vector<std::pair<double, Index>> found_;
};

}  // namespace cathlab
