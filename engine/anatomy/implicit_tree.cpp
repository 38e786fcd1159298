#include "anatomy/implicit_tree.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace cathlab {
namespace {

constexpr double cell_mm = 6.0;
constexpr std::size_t most_near = 16;

std::int64_t cell_key(std::int64_t i, std::int64_t j, std::int64_t k) {
    constexpr std::int64_t offset = 1 << 20;
    return ((i + offset) << 42) | ((j + offset) << 21) | (k + offset);
}

std::int64_t cell_index(double x) {
    return static_cast<std::int64_t>(std::floor(x / cell_mm));
}

/// Smooth minimum with its gradient: b is mixed into a.
void smooth_min(double& value, Vec3& gradient, double other, const Vec3& other_gradient, double k) {
    const double h = k > 0.0 ? std::max(k - std::fabs(value - other), 0.0) / k : 0.0;
    const bool other_wins = other < value;
    const double weight = other_wins ? 1.0 - 0.5 * h : 0.5 * h;
    value = std::min(value, other) - 0.25 * h * h * k;
    gradient = (1.0 - weight) * gradient + weight * other_gradient;
}

void smooth_max(double& value, Vec3& gradient, double other, const Vec3& other_gradient, double k) {
    value = -value;
    gradient = -gradient;
    smooth_min(value, gradient, -other, -other_gradient, k);
    value = -value;
    gradient = -gradient;
}

}  // namespace

ImplicitTree::ImplicitTree(std::vector<Vessel> vessels, std::vector<Branch> branches, std::vector<Bulge> bulges,
                           double reach_mm)
    : vessels_(std::move(vessels)), branches_(std::move(branches)), bulges_(std::move(bulges)), reach_(reach_mm) {
    low_ = Vec3::Constant(1e300);
    high_ = Vec3::Constant(-1e300);
    for (std::size_t v = 0; v < vessels_.size(); ++v) {
        const Curve& c = vessels_[v].curve;
        length_.push_back(c.length());
        auto add = [&](const Vec3& a, const Vec3& b, double ra, double rb, double arc, double width) {
            const Vec3 ab = b - a;
            segments_.push_back(
                {a, ab, 1.0 / std::max(ab.squaredNorm(), 1e-30), ra, rb - ra, arc, width, static_cast<Index>(v)});
        };
        // a capped end runs on by one and a half radii, so that the cutting plane finds a full tube to cut
        if (vessels_[v].cap_start) {
            const double r = c.radius.front();
            add(c.position.front() - 1.5 * r * c.tangent(0.0), c.position.front(), r, r, -1.5 * r, 1.5 * r);
        }
        for (std::size_t i = 0; i + 1 < c.position.size(); ++i)
            add(c.position[i], c.position[i + 1], c.radius[i], c.radius[i + 1], c.arc[i], c.arc[i + 1] - c.arc[i]);
        if (vessels_[v].cap_end) {
            const double r = c.radius.back();
            add(c.position.back(), c.position.back() + 1.5 * r * c.tangent(c.length()), r, r, c.length(), 1.5 * r);
        }
    }
    for (std::size_t s = 0; s < segments_.size(); ++s) {
        const Segment& g = segments_[s];
        const double bulge = bulges_.empty() ? 0.0 : 8.0;  // sinuses stand out of their tube
        const double grow = std::max(g.ra, g.ra + g.dr) + reach_ + bulge;
        const Vec3 lo = g.a.cwiseMin(g.a + g.ab).array() - grow;
        const Vec3 hi = g.a.cwiseMax(g.a + g.ab).array() + grow;
        low_ = low_.cwiseMin(lo);
        high_ = high_.cwiseMax(hi);
        for (std::int64_t i = cell_index(lo.x()); i <= cell_index(hi.x()); ++i) {
            for (std::int64_t j = cell_index(lo.y()); j <= cell_index(hi.y()); ++j) {
                for (std::int64_t k = cell_index(lo.z()); k <= cell_index(hi.z()); ++k)
                    cells_[cell_key(i, j, k)].push_back(static_cast<Index>(s));
            }
        }
    }
}

const std::vector<Index>* ImplicitTree::cell(const Vec3& p) const {
    const auto it = cells_.find(cell_key(cell_index(p.x()), cell_index(p.y()), cell_index(p.z())));
    return it == cells_.end() ? nullptr : &it->second;
}

void ImplicitTree::close_ends(Near& n, const Vec3& p) const {
    const auto v = static_cast<std::size_t>(n.vessel);
    const Curve& c = vessels_[v].curve;
    const double length = length_[v];
    if (vessels_[v].cap_start && n.arc < 2.0 * c.radius.front()) {
        const Vec3 out = -c.tangent(0.0);
        smooth_max(n.d, n.gradient, (p - c.position.front()).dot(out), out, 0.3 * c.radius.front());
    }
    if (vessels_[v].cap_end && n.arc > length - 2.0 * c.radius.back()) {
        const Vec3 out = c.tangent(length);
        smooth_max(n.d, n.gradient, (p - c.position.back()).dot(out), out, 0.3 * c.radius.back());
    }
    n.arc = std::clamp(n.arc, 0.0, length);
}

std::size_t ImplicitTree::near_vessels(const Vec3& p, Near* out) const {
    const std::vector<Index>* list = cell(p);
    if (list == nullptr) return 0;
    std::size_t count = 0;
    double best_t = 0.0;
    const Segment* best = nullptr;
    double best_d = 1e300;
    auto flush = [&] {
        if (best == nullptr || count == most_near) return;
        const Vec3 from = p - (best->a + best_t * best->ab);
        const double distance = from.norm();
        Near n{best->vessel, best_d, best->ra + best_t * best->dr, best->arc + best_t * best->width,
               distance > 1e-9 ? Vec3(from / distance) : Vec3(best->ab.unitOrthogonal())};
        close_ends(n, p);
        out[count++] = n;
    };
    for (const Index s : *list) {  // segments stand in order of their vessels
        const Segment& g = segments_[static_cast<std::size_t>(s)];
        if (best != nullptr && g.vessel != best->vessel) {
            flush();
            best = nullptr;
            best_d = 1e300;
        }
        const Vec3 ap = p - g.a;
        const double t = std::clamp(ap.dot(g.ab) * g.inverse, 0.0, 1.0);
        const double d = (ap - t * g.ab).norm() - (g.ra + t * g.dr);
        if (d < best_d) {
            best_d = d;
            best_t = t;
            best = &g;
        }
    }
    flush();
    for (const Bulge& b : bulges_) {
        for (std::size_t i = 0; i < count; ++i) {
            if (out[i].vessel != b.vessel) continue;
            const Vec3 from = p - b.center;
            const double distance = std::max(from.norm(), 1e-9);
            smooth_min(out[i].d, out[i].gradient, distance - b.radius, from / distance, b.blend_mm);
        }
    }
    for (std::size_t i = 0; !bulges_.empty() && i < count; ++i) {
        if (out[i].vessel == bulges_.front().vessel) close_ends(out[i], p);
    }
    return count;
}

FieldSample ImplicitTree::sample(const Vec3& p) const {
    Near near[most_near];
    const std::size_t count = near_vessels(p, near);
    FieldSample out;
    for (std::size_t i = 0; i < count; ++i) {
        if (near[i].d < out.value) {
            out.value = near[i].d;
            out.gradient = near[i].gradient;
            out.vessel = near[i].vessel;
            out.radius = near[i].radius;
            out.arc = near[i].arc;
        }
    }
    if (count < 2) return out;
    for (const Branch& b : branches_) {
        const double distance = (p - b.center).norm();
        if (distance >= b.outer) continue;
        const double u = std::clamp((b.outer - distance) / (b.outer - b.inner), 0.0, 1.0);
        const double k = b.blend_mm * u * u * (3.0 - 2.0 * u);
        bool any = false;
        double value = 0.0;
        Vec3 gradient = Vec3::Zero();
        auto join = [&](Index v, double blend) {
            for (std::size_t i = 0; i < count; ++i) {
                if (near[i].vessel != v) continue;
                if (!any) {
                    value = near[i].d;
                    gradient = near[i].gradient;
                    any = true;
                } else {
                    smooth_min(value, gradient, near[i].d, near[i].gradient, blend);
                }
            }
        };
        for (const Index v : b.trunk) join(v, 0.0);
        for (const Index v : b.children) join(v, k);
        if (any && value < out.value) {
            out.value = value;
            out.gradient = gradient;
        }
    }
    return out;
}

double ImplicitTree::vessel_distance(const Vec3& p, Index vessel) const {
    const Curve& c = vessels_[static_cast<std::size_t>(vessel)].curve;
    double best = 1e300;
    for (std::size_t i = 0; i + 1 < c.position.size(); ++i) {
        const Vec3 ab = c.position[i + 1] - c.position[i];
        const double t = std::clamp((p - c.position[i]).dot(ab) / std::max(ab.squaredNorm(), 1e-30), 0.0, 1.0);
        best = std::min(best, (p - c.position[i] - t * ab).norm() - c.radius[i] - t * (c.radius[i + 1] - c.radius[i]));
    }
    for (const Bulge& b : bulges_) {
        if (b.vessel == vessel) best = std::min(best, (p - b.center).norm() - b.radius);
    }
    return best;
}

double ImplicitTree::size(const Vec3& p, const SizingLaw& law) const {
    Near near[most_near];
    const std::size_t count = near_vessels(p, near);
    double best = law.longest;
    for (std::size_t i = 0; i < count; ++i) {
        const double limit =
            law.vessel_longest.empty() ? law.longest : law.vessel_longest[static_cast<std::size_t>(near[i].vessel)];
        const double edge = std::min(limit, 2.0 * 3.14159265358979323846 * near[i].radius / law.edges_round);
        best = std::min(best, edge + law.grading * std::max(0.0, near[i].d));
    }
    return best;
}

}  // namespace cathlab
