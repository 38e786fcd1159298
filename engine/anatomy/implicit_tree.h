// The vessel tree as a signed distance: tubes of varying radius, joined smoothly at their declared branches alone.
//
// d_v(p) = |p - c(t)| - r(t) at the nearest point of vessel v (negative inside); free ends are closed by a flat cap
// with a rounded rim.  The tree is min over v of d_v, and at each branch the smooth minimum
//     smin(a, b, k) = min(a, b) - h^2 k / 4,  h = max(k - |a - b|, 0) / k
// with k = blend x (smaller radius), faded out away from the branch: vessels that merely run near each other stay
// apart.
#pragma once

#include <unordered_map>
#include <vector>

#include "anatomy/curve.h"

namespace cathlab {

struct FieldSample {
    double value = 1e3;  ///< signed distance, mm (1e3 far away)
    Vec3 gradient = Vec3::UnitZ();
    Index vessel = -1;    ///< nearest vessel
    double radius = 0.0;  ///< of that vessel's lumen nearby, mm
    double arc = 0.0;     ///< along that vessel, mm
};

/// Sizes wanted by a mesh: smallest over the vessels of (edge_v + grading x distance to v's wall).
struct SizingLaw {
    double edges_round = 12.0;           ///< edge = 2 pi r / edges_round ...
    double longest = 3.0;                ///< ... but never above this, mm
    double grading = 0.35;               ///< growth of the edge per mm
    std::vector<double> vessel_longest;  ///< one a vessel, or empty
};

class ImplicitTree {
public:
    struct Vessel {
        Curve curve;
        bool cap_start = false;  ///< closed by a flat cap (else round, inside another vessel)
        bool cap_end = false;
    };
    struct Branch {
        std::vector<Index> trunk;     ///< the parent and what continues it, without a seam: plain minimum
        std::vector<Index> children;  ///< joined to the trunk smoothly
        Vec3 center = Vec3::Zero();
        double blend_mm = 0.0;  ///< k at the branch
        double inner = 0.0;     ///< full blend up to this distance from the centre
        double outer = 0.0;     ///< none from here on
    };
    struct Bulge {
        Index vessel = 0;
        Vec3 center = Vec3::Zero();
        double radius = 0.0;
        double blend_mm = 0.0;
    };

    ImplicitTree(std::vector<Vessel> vessels, std::vector<Branch> branches, std::vector<Bulge> bulges, double reach_mm);

    FieldSample sample(const Vec3& p) const;
    double size(const Vec3& p, const SizingLaw& law) const;
    /// Distance to one vessel's wall alone (with its bulges, without caps); any place, slow.
    double vessel_distance(const Vec3& p, Index vessel) const;
    const std::vector<Vessel>& vessels() const { return vessels_; }
    Vec3 low() const { return low_; }
    Vec3 high() const { return high_; }
    double reach() const { return reach_; }

private:
    struct Segment {
        Vec3 a, ab;
        double inverse, ra, dr, arc, width;
        Index vessel;
    };
    struct Near {
        Index vessel;
        double d;
        double radius;
        double arc;
        Vec3 gradient;
    };
    const std::vector<Index>* cell(const Vec3& p) const;
    std::size_t near_vessels(const Vec3& p, Near* out) const;
    void close_ends(Near& n, const Vec3& p) const;

    std::vector<Vessel> vessels_;
    std::vector<Branch> branches_;
    std::vector<Bulge> bulges_;
    double reach_;
    std::vector<Segment> segments_;
    std::vector<double> length_;
    std::unordered_map<std::int64_t, std::vector<Index>> cells_;
    Vec3 low_ = Vec3::Zero();
    Vec3 high_ = Vec3::Zero();
};

}  // namespace cathlab
