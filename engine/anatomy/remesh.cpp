#include "anatomy/remesh.h"

#include <algorithm>
#include <cmath>

namespace cathlab {
namespace {

/// A closed manifold surface that can be edited: triangles round every vertex are known.
class Remesher {
public:
    Remesher(const TriMesh& mesh, const RemeshGoal& goal, const Workers& workers)
        : p_(mesh.vertices), t_(mesh.triangles), goal_(goal), workers_(workers) {
        around_.resize(p_.size());
        for (std::size_t i = 0; i < t_.size(); ++i) {
            for (int k = 0; k < 3; ++k) at(t_[i][k]).push_back(static_cast<Index>(i));
        }
        size_.resize(p_.size());
        measure_sizes();
    }

    TriMesh run() {
        for (int round = 0; round < goal_.rounds; ++round) {
            split_long();
            const std::size_t passes = round == 0 ? 6 : 2;
            for (std::size_t pass = 0; pass < passes; ++pass) {
                if (collapse_short() * 200 < t_.size()) break;
            }
            flip(false);
            mend_needles();
            relax();
            project();
            measure_sizes();
        }
        for (int k = 0; k < 3; ++k) {
            flip(true);
            mend_needles();
            relax();
            project();
        }
        flip(true);
        mend_needles();
        flip(true);
        return compacted();
    }

private:
    std::vector<Vec3> p_;
    std::vector<Triangle> t_;  // t[0] < 0: gone
    std::vector<std::vector<Index>> around_;
    std::vector<double> size_;
    const RemeshGoal& goal_;
    const Workers& workers_;
    std::vector<Index> ring_a_, ring_b_;

    std::vector<Index>& at(Index v) { return around_[static_cast<std::size_t>(v)]; }
    Vec3& p(Index v) { return p_[static_cast<std::size_t>(v)]; }
    double& size(Index v) { return size_[static_cast<std::size_t>(v)]; }
    Triangle& tri(Index t) { return t_[static_cast<std::size_t>(t)]; }

    void measure_sizes() {
        workers_.for_ranges(p_.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                if (!around_[i].empty()) size_[i] = goal_.size(p_[i]);
            }
        });
    }

    /// Collapses the shortest edge of triangles that are needles.
    void mend_needles() {
        for (const Triangle& current : t_) {
            if (current[0] < 0) continue;
            const Triangle t = current;  // as it is before it collapses
            double shortest = 1e300;
            double longest = 0.0;
            int at_edge = 0;
            for (int k = 0; k < 3; ++k) {
                const double l = length(t[k], t[(k + 1) % 3]);
                longest = std::max(longest, l);
                if (l < shortest) {
                    shortest = l;
                    at_edge = k;
                }
            }
            const double area = normal(p(t[0]), p(t[1]), p(t[2])).norm();
            if (area < 0.2 * longest * longest && shortest < 0.4 * longest)
                collapse(t[at_edge], t[(at_edge + 1) % 3], 2.0 * longest);
        }
    }

    double length(Index a, Index b) { return (p(a) - p(b)).norm(); }
    double wanted(Index a, Index b) { return 0.5 * (size(a) + size(b)); }

    static bool has(const Triangle& t, Index v) { return t[0] == v || t[1] == v || t[2] == v; }
    static void replace(Triangle& t, Index from, Index to) {
        for (int k = 0; k < 3; ++k) {
            if (t[k] == from) t[k] = to;
        }
    }
    void drop(Index v, Index triangle) {
        std::vector<Index>& list = at(v);
        list.erase(std::find(list.begin(), list.end(), triangle));
    }
    /// The two triangles at edge ab: left runs a -> b.  False where there are not exactly two.
    bool wings(Index a, Index b, Index& left, Index& right) {
        left = right = -1;
        for (const Index i : at(a)) {
            const Triangle& t = tri(i);
            for (int k = 0; k < 3; ++k) {
                if (t[k] == a && t[(k + 1) % 3] == b) {
                    if (left >= 0) return false;
                    left = i;
                }
                if (t[k] == b && t[(k + 1) % 3] == a) {
                    if (right >= 0) return false;
                    right = i;
                }
            }
        }
        return left >= 0 && right >= 0;
    }
    static Index opposite(const Triangle& t, Index a, Index b) {
        for (int k = 0; k < 3; ++k) {
            if (t[k] != a && t[k] != b) return t[k];
        }
        return -1;
    }
    void ring(Index v, std::vector<Index>& out) {
        out.clear();
        for (const Index i : at(v)) {
            for (int k = 0; k < 3; ++k) {
                if (tri(i)[k] != v) out.push_back(tri(i)[k]);
            }
        }
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
    }
    Vec3 normal(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - a); }

    template <class Body>
    void each_edge(Body&& body) {
        const std::size_t count = t_.size();
        for (std::size_t i = 0; i < count; ++i) {
            for (int k = 0; k < 3; ++k) {
                if (t_[i][0] < 0) break;
                const Index a = t_[i][k];
                const Index b = t_[i][(k + 1) % 3];
                if (a < b) body(a, b);
            }
        }
    }

    void split_long() {
        for (int pass = 0; pass < 6; ++pass) {
            std::size_t done = 0;
            each_edge([&](Index a, Index b) {
                if (length(a, b) > 4.0 / 3.0 * wanted(a, b)) {
                    split(a, b);
                    ++done;
                }
            });
            if (done == 0) return;
        }
    }

    void split(Index a, Index b) {
        Index left = 0;
        Index right = 0;
        if (!wings(a, b, left, right)) return;
        const Index m = static_cast<Index>(p_.size());
        const Vec3 middle = 0.5 * (p(a) + p(b));
        p_.push_back(middle);
        size_.push_back(goal_.size(middle));
        around_.emplace_back();
        for (const Index side : {left, right}) {
            const Index c = opposite(tri(side), a, b);
            const Index fresh = static_cast<Index>(t_.size());
            Triangle copy = tri(side);
            replace(tri(side), b, m);  // keeps a
            replace(copy, a, m);       // keeps b
            t_.push_back(copy);
            drop(b, side);
            at(b).push_back(fresh);
            at(c).push_back(fresh);
            at(m).push_back(side);
            at(m).push_back(fresh);
        }
    }

    std::size_t collapse_short() {
        std::size_t done = 0;
        each_edge([&](Index a, Index b) {
            if (length(a, b) < 4.0 / 5.0 * wanted(a, b) && collapse(a, b)) ++done;
        });
        return done;
    }

    bool stays_good(Index v, Index other, const Vec3& target, double limit) {
        for (const Index i : at(v)) {
            const Triangle& t = tri(i);
            if (has(t, other)) continue;
            Vec3 q[3];
            for (int k = 0; k < 3; ++k) {
                q[k] = t[k] == v ? target : p(t[k]);
                if (t[k] != v && (q[k] - target).norm() > limit) return false;
            }
            const Vec3 before = normal(p(t[0]), p(t[1]), p(t[2]));
            const Vec3 after = normal(q[0], q[1], q[2]);
            const double longest =
                std::max({(q[1] - q[0]).squaredNorm(), (q[2] - q[1]).squaredNorm(), (q[0] - q[2]).squaredNorm()});
            if (after.norm() < 0.1 * longest) return false;  // a sliver
            const double was = std::max({(p(t[1]) - p(t[0])).squaredNorm(), (p(t[2]) - p(t[1])).squaredNorm(),
                                         (p(t[0]) - p(t[2])).squaredNorm()});
            if (before.norm() < 0.1 * was) continue;  // a sliver's normal says nothing
            if (before.dot(after) < 0.5 * before.norm() * after.norm()) return false;
        }
        return true;
    }

    bool collapse(Index a, Index b, double longest_allowed = 0.0) {
        Index left = 0;
        Index right = 0;
        if (!wings(a, b, left, right)) return false;
        const Index c = opposite(tri(left), a, b);
        const Index d = opposite(tri(right), a, b);
        if (c == d || at(c).size() <= 3 || at(d).size() <= 3) return false;
        ring(a, ring_a_);
        ring(b, ring_b_);
        std::size_t common = 0;  // link condition: a and b share c and d alone
        for (const Index v : ring_a_) common += std::binary_search(ring_b_.begin(), ring_b_.end(), v) ? 1 : 0;
        if (common != 2) return false;
        if (at(a).size() + at(b).size() - 4 > 10) return false;
        const Vec3 target = 0.5 * (p(a) + p(b));
        const double limit = std::max(4.0 / 3.0 * wanted(a, b), longest_allowed);
        if (!stays_good(a, b, target, limit) || !stays_good(b, a, target, limit)) return false;
        p(a) = target;
        size(a) = wanted(a, b);
        for (const Index gone : {left, right}) {
            const Triangle t = tri(gone);
            for (int k = 0; k < 3; ++k) drop(t[k], gone);
            tri(gone) = Triangle(-1, -1, -1);
        }
        for (const Index i : at(b)) {
            replace(tri(i), b, a);
            at(a).push_back(i);
        }
        at(b).clear();
        return true;
    }

    static double cosine(const Vec3& at, const Vec3& u, const Vec3& v) {
        const Vec3 a = u - at;
        const Vec3 b = v - at;
        return a.dot(b) / std::max(a.norm() * b.norm(), 1e-300);
    }

    /// Either towards six triangles round every vertex, or towards Delaunay (the two angles that face an edge sum to <
    /// pi).
    void flip(bool delaunay) {
        each_edge([&](Index a, Index b) {
            Index left = 0;
            Index right = 0;
            if (!wings(a, b, left, right)) return;
            const Index c = opposite(tri(left), a, b);
            const Index d = opposite(tri(right), a, b);
            if (c == d || at(a).size() <= 3 || at(b).size() <= 3) return;
            if (delaunay) {
                // cot + cot < 0 <=> the angles sum to more than pi <=> cos(c) + cos(d) < 0 for angles in (0, pi)
                if (cosine(p(c), p(a), p(b)) + cosine(p(d), p(a), p(b)) >= -1e-6) return;
            } else {
                auto off = [](std::size_t n) {
                    return (static_cast<double>(n) - 6.0) * (static_cast<double>(n) - 6.0);
                };
                const double before = off(at(a).size()) + off(at(b).size()) + off(at(c).size()) + off(at(d).size());
                const double after =
                    off(at(a).size() - 1) + off(at(b).size() - 1) + off(at(c).size() + 1) + off(at(d).size() + 1);
                if (after >= before) return;
            }
            for (const Index i : at(c)) {
                if (has(tri(i), d)) return;  // the edge cd is there already
            }
            const Vec3 n0 = normal(p(a), p(b), p(c));
            const Vec3 n1 = normal(p(b), p(a), p(d));
            const Vec3 m0 = normal(p(a), p(d), p(c));
            const Vec3 m1 = normal(p(d), p(b), p(c));
            const double longest = std::max((p(c) - p(d)).squaredNorm(), (p(a) - p(b)).squaredNorm());
            const bool sliver = std::min(n0.norm(), n1.norm()) < 0.1 * (p(a) - p(b)).squaredNorm();
            if (!sliver && n0.dot(n1) < 0.7 * n0.norm() * n1.norm()) return;  // never across a crease
            const Vec3 n = (n0 + n1).normalized();
            if (m0.dot(n) < 0.08 * longest || m1.dot(n) < 0.08 * longest) return;
            tri(left) = Triangle(a, d, c);
            tri(right) = Triangle(d, b, c);
            drop(a, right);
            drop(b, left);
            at(d).push_back(left);
            at(c).push_back(right);
        });
    }

    void relax() {
        std::vector<Vec3> next = p_;
        workers_.for_ranges(p_.size(), 1024, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                if (around_[v].empty()) continue;
                Vec3 sum = Vec3::Zero();
                Vec3 n = Vec3::Zero();
                double weight = 0.0;
                for (const Index i : around_[v]) {
                    const Triangle& t = t_[static_cast<std::size_t>(i)];
                    const Vec3 area = normal(p(t[0]), p(t[1]), p(t[2]));
                    const double wish = (size(t[0]) + size(t[1]) + size(t[2])) / 3.0;
                    const double w = area.norm() / (wish * wish * wish);
                    sum += w * (p(t[0]) + p(t[1]) + p(t[2])) / 3.0;
                    weight += w;
                    n += area;
                }
                if (!(weight > 0.0) || !(n.norm() > 0.0)) continue;
                n.normalize();
                const Vec3 move = sum / weight - p_[v];
                next[v] = p_[v] + 0.8 * (move - move.dot(n) * n);
            }
        });
        p_ = std::move(next);
    }

    void project() {
        if (!goal_.project) return;
        workers_.for_ranges(p_.size(), 512, [&](std::size_t begin, std::size_t end) {
            for (std::size_t v = begin; v < end; ++v) {
                if (!around_[v].empty()) p_[v] = goal_.project(p_[v], size_[v]);
            }
        });
    }

    TriMesh compacted() {
        TriMesh out;
        std::vector<Index> place(p_.size(), -1);
        for (std::size_t v = 0; v < p_.size(); ++v) {
            if (around_[v].empty()) continue;
            place[v] = static_cast<Index>(out.vertices.size());
            out.vertices.push_back(p_[v]);
        }
        for (const Triangle& t : t_) {
            if (t[0] < 0) continue;
            Triangle u;
            for (int k = 0; k < 3; ++k) u[k] = place[static_cast<std::size_t>(t[k])];
            out.triangles.push_back(u);
        }
        return out;
    }
};

}  // namespace

TriMesh remesh(const TriMesh& mesh, const RemeshGoal& goal, const Workers& workers) {
    return Remesher(mesh, goal, workers).run();
}

}  // namespace cathlab
