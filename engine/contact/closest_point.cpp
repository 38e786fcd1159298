#include "contact/closest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/triangle_point.h"
#include "core/check.h"

namespace cathlab {
namespace {

constexpr double on_surface_mm = 1e-6;       ///< nearer than this p - q has no direction
constexpr double patch_slack_mm = 0.5;       ///< bridges the bumps of a coarse mesh between the hint and the near wall
constexpr double hint_reach_mm = 6.0;        ///< a hint further away belongs to another part of the run
constexpr std::size_t patch_limit = 1024;    ///< triangles of a patch; breadth first, so what is cut off is far
constexpr double other_wall_cosine = 0.906;  ///< walls count as different when they differ by 25 degrees

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

TrianglePoint on_triangle(const LumenSurfaceModel& model, const LumenSurfaceState& state, const Vec3& p,
                          Index triangle) {
    const Triangle& t = model.triangles[at(triangle)];
    return closest_on_triangle(p, state.vertices[at(t[0])], state.vertices[at(t[1])], state.vertices[at(t[2])]);
}

struct Nearest {
    Index triangle = -1;
    TrianglePoint foot;

    /// Takes the candidate if it is nearer, or as near with a lower index: the answer does not depend on the order of
    /// visits.
    void offer(Index candidate, const TrianglePoint& f) {
        if (f.squared_distance < foot.squared_distance ||
            (f.squared_distance == foot.squared_distance && (triangle < 0 || candidate < triangle))) {
            triangle = candidate;
            foot = f;
        }
    }
};

template <class Visit, class Bound>
void visit_triangles(const LumenSurfaceModel& model, const LumenSurfaceState& state, const NearTriangles* near,
                     const Vec3& p, const Bound& bound, const Visit& visit) {
    if (near)
        for_near_triangles(*near, bound, visit);
    else
        for_near_triangles(model.tree, state.boxes, p, bound, visit);
}

Vec3 pseudo_normal(const LumenSurfaceModel& model, const LumenSurfaceState& state, Index triangle, int feature) {
    Vec3 normal = Vec3::Zero();
    if (feature < 3) {
        normal = inward_vertex_normal(model, state, model.triangles[at(triangle)][feature]);
    } else {
        normal = feature < 6 ? inward_edge_normal(model, state, triangle, feature - 3)
                             : inward_triangle_normal(model, state, triangle);
    }
    if (normal.squaredNorm() > 0.0) return normal;
    // Degenerate here: what the surroundings say.
    for (int k = 0; k < 3; ++k) normal += inward_vertex_normal(model, state, model.triangles[at(triangle)][k]);
    const double length = normal.norm();
    return length > 1e-12 ? Vec3(normal / length) : Vec3(Vec3::Zero());
}

SurfacePoint with_side(const LumenSurfaceModel& model, const LumenSurfaceState& state, const Vec3& p,
                       const Nearest& n) {
    SurfacePoint s;
    s.triangle = n.triangle;
    s.barycentric = n.foot.barycentric;
    s.point = n.foot.point;
    const Vec3 normal = pseudo_normal(model, state, n.triangle, n.foot.feature);
    const Vec3 offset = p - n.foot.point;
    const double distance = std::sqrt(n.foot.squared_distance);
    const double sign = normal.dot(offset) >= 0.0 ? 1.0 : -1.0;
    s.signed_distance = sign * distance;
    s.inward_normal = distance > on_surface_mm ? Vec3(sign / distance * offset) : normal;
    return s;
}

bool share_a_corner(const Triangle& a, const Triangle& b) {
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (a[i] == b[j]) return true;
        }
    }
    return false;
}

/// Closest point of the patch: the triangles connected to `hint` within sqrt(reach2) of p.  holds_goal: `goal` is one
/// of them.
Nearest closest_of_patch(const LumenSurfaceModel& model, const LumenSurfaceState& state, const Vec3& p, Index hint,
                         double reach2, Index goal, bool& holds_goal) {
    std::vector<Index> patch{hint};
    std::vector<Index> seen{hint};  // ascending
    Nearest nearest;
    nearest.foot.squared_distance = std::numeric_limits<double>::infinity();
    holds_goal = false;
    for (std::size_t i = 0; i < patch.size() && patch.size() < patch_limit; ++i) {
        const TrianglePoint foot = on_triangle(model, state, p, patch[i]);
        if (foot.squared_distance > reach2) continue;
        nearest.offer(patch[i], foot);
        if (patch[i] == goal) {
            holds_goal = true;
            return nearest;
        }
        for (int k = 0; k < 3; ++k) {
            const Index next = model.across[at(patch[i])][k];
            if (next < 0) continue;
            const auto place = std::lower_bound(seen.begin(), seen.end(), next);
            if (place != seen.end() && *place == next) continue;
            seen.insert(place, next);
            patch.push_back(next);
        }
    }
    return nearest;
}

}  // namespace

SurfacePoint closest(const LumenSurfaceModel& model, const LumenSurfaceState& state, const Vec3& p, double max_distance,
                     Index hint, const NearTriangles* near) {
    CATHLAB_CHECK(p.allFinite(), "a device point must be finite");
    CATHLAB_CHECK(hint < static_cast<Index>(model.triangles.size()), "hint is no triangle of this surface");
    Nearest best;
    best.foot.squared_distance = max_distance * max_distance;
    double hint2 = std::numeric_limits<double>::infinity();
    if (hint >= 0) {
        const TrianglePoint foot = on_triangle(model, state, p, hint);
        hint2 = foot.squared_distance;
        best.offer(hint, foot);
    }
    // Boxes and triangles round differently: without the slack an equally near triangle of lower index could be cut
    // off.
    visit_triangles(
        model, state, near, p, [&] { return best.foot.squared_distance * (1.0 + 1e-12); },
        [&](Index t) { best.offer(t, on_triangle(model, state, p, t)); });
    if (best.triangle < 0) return {};

    const bool near_hint = hint >= 0 && hint2 <= hint_reach_mm * hint_reach_mm;
    if (near_hint && best.triangle != hint &&
        !share_a_corner(model.triangles[at(hint)], model.triangles[at(best.triangle)])) {
        const double reach = std::sqrt(hint2) + patch_slack_mm;
        bool connected = false;
        const Nearest local = closest_of_patch(model, state, p, hint, reach * reach, best.triangle, connected);
        if (!connected && local.triangle >= 0) {
            const SurfacePoint own = with_side(model, state, p, local);
            if (own.signed_distance < 0.0) {
                return -own.signed_distance <= max_distance ? own : SurfacePoint{};
            }
        }
    }
    return with_side(model, state, p, best);
}

SurfacePoint closest_credible(const LumenSurfaceModel& model, const LumenSurfaceState& state, const Vec3& p,
                              double max_distance, Index hint, double radius, const WallSeen& seen,
                              const NearTriangles* near) {
    const auto credible = [&](const SurfacePoint& s) {
        return !s.found() || s.signed_distance >= 0.0 ||
               radius - s.signed_distance <= seen.depth_mm + credible_slack_mm ||
               s.inward_normal.dot(seen.pressed_by) > 0.0;
    };
    SurfacePoint found = closest(model, state, p, max_distance, hint, near);
    if (!credible(found) && hint >= 0) found = closest(model, state, p, max_distance, -1, near);
    return credible(found) ? found : SurfacePoint{};
}

std::optional<SurfacePoint> first_exit(const LumenSurfaceModel& model, const LumenSurfaceState& state, const Vec3& a,
                                       const Vec3& b) {
    CATHLAB_CHECK(a.allFinite() && b.allFinite(), "a device point must be finite");
    const Vec3 along = b - a;
    const Vec3 middle = 0.5 * (a + b);
    const double half2 = 0.25 * along.squaredNorm();
    constexpr double edge_slack = 1e-9;  // in barycentric terms: no slit between two triangles
    double first = 2.0;
    std::optional<SurfacePoint> exit;
    // The ball around the segment holds it; segments are short (the motion of one substep).
    for_near_triangles(
        model.tree, state.boxes, middle, [&] { return half2 * (1.0 + 1e-12) + 1e-18; },
        [&](Index t) {
            const Triangle& corner = model.triangles[at(t)];
            const Vec3& v0 = state.vertices[at(corner[0])];
            const Vec3 e1 = state.vertices[at(corner[1])] - v0;
            const Vec3 e2 = state.vertices[at(corner[2])] - v0;
            const Vec3 outward = e1.cross(e2);
            const double leaving = outward.dot(along);
            if (!(leaving > 0.0)) return;
            // Cramer's rule for a + s along = v0 + u e1 + v e2; the common denominator is -outward . along.
            const Vec3 from = a - v0;
            const double s = -outward.dot(from) / leaving;
            if (s < 0.0 || s > 1.0 || s > first || (s == first && exit && exit->triangle < t)) return;
            const Vec3 cross = along.cross(from);
            const double u = e2.dot(cross) / leaving;
            const double v = -e1.dot(cross) / leaving;
            if (u < -edge_slack || v < -edge_slack || u + v > 1.0 + edge_slack) return;
            first = s;
            SurfacePoint hit;
            hit.triangle = t;
            hit.barycentric = Vec3(1.0 - u - v, u, v);
            hit.point = a + s * along;
            hit.inward_normal = -outward.normalized();
            hit.signed_distance = hit.inward_normal.dot(b - hit.point);
            exit = hit;
        });
    return exit;
}

std::vector<SurfacePoint> further_walls(const LumenSurfaceModel& model, const LumenSurfaceState& state, const Vec3& p,
                                        double reach, const SurfacePoint& nearest, const Vec3& nearest_normal,
                                        int at_most, const NearTriangles* near) {
    std::vector<SurfacePoint> candidates;
    if (at_most <= 0 || !nearest.found()) return candidates;
    const double reach2 = reach * reach;
    visit_triangles(
        model, state, near, p, [&] { return reach2; },
        [&](Index t) {
            if (t == nearest.triangle) return;
            // Most triangles of a wide vessel face as the nearest one does: sorted out before anything dear.
            const Triangle& corner = model.triangles[at(t)];
            const Vec3& a = state.vertices[at(corner[0])];
            const Vec3 facing = (state.vertices[at(corner[2])] - a).cross(state.vertices[at(corner[1])] - a);
            const double along = facing.dot(nearest_normal);
            if (along > 0.0 && along * along > other_wall_cosine * other_wall_cosine * facing.squaredNorm()) return;
            const TrianglePoint foot = on_triangle(model, state, p, t);
            if (foot.squared_distance > reach2) return;
            const Vec3 across = foot.point - nearest.point;
            if (across.dot(nearest_normal) <= 0.0) return;
            SurfacePoint wall;
            wall.inward_normal = inward_smooth_normal(model, state, t, foot.barycentric);
            if (wall.inward_normal.dot(nearest_normal) > other_wall_cosine || across.dot(wall.inward_normal) >= 0.0)
                return;
            wall.triangle = t;
            wall.barycentric = foot.barycentric;
            wall.point = foot.point;
            wall.signed_distance = wall.inward_normal.dot(p - foot.point);
            candidates.push_back(wall);
        });
    std::sort(candidates.begin(), candidates.end(), [](const SurfacePoint& a, const SurfacePoint& b) {
        return a.signed_distance < b.signed_distance ||
               (a.signed_distance == b.signed_distance && a.triangle < b.triangle);
    });
    std::vector<SurfacePoint> chosen;
    for (const SurfacePoint& c : candidates) {
        if (static_cast<int>(chosen.size()) == at_most) break;
        const bool differs = std::all_of(chosen.begin(), chosen.end(), [&](const SurfacePoint& other) {
            return c.inward_normal.dot(other.inward_normal) <= other_wall_cosine;
        });
        if (differs) chosen.push_back(c);
    }
    return chosen;
}

}  // namespace cathlab
