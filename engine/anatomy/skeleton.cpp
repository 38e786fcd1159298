#include "anatomy/skeleton.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <set>

namespace cathlab {
namespace {

constexpr std::size_t most_loops = 40;
constexpr double shortest_branch = 5.0;  // mm beyond the trunk's lumen

/// Lattice points inside the lumen with their depth and 26 neighbours.
class Lattice {
public:
    Lattice(const DistanceGrid& distance, const Vec3& low, const Vec3& high, double spacing, const Workers& workers)
        : low_(low - Vec3::Constant(spacing)), spacing_(spacing) {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto e = static_cast<Eigen::Index>(k);
            count_[k] = static_cast<std::int64_t>(std::ceil((high[e] - low[e]) / spacing)) +
                        3;  // a rim outside: no bounds to check
        }
        std::vector<float> depth(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]));
        workers.for_ranges(depth.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                depth[i] = static_cast<float>(-distance.value(place_of(static_cast<std::int64_t>(i))));
        });
        number_.assign(depth.size(), -1);
        for (std::size_t i = 0; i < depth.size(); ++i) {
            if (depth[i] <= 0.1F * static_cast<float>(spacing)) continue;
            number_[i] = static_cast<Index>(cell.size());
            cell.push_back(static_cast<std::int64_t>(i));
            this->depth.push_back(static_cast<double>(depth[i]));
        }
        for (int dz = -1; dz <= 1; ++dz) {
            for (int dy = -1; dy <= 1; ++dy) {
                for (int dx = -1; dx <= 1; ++dx) {
                    if (dx == 0 && dy == 0 && dz == 0) continue;
                    steps_.push_back({dx + count_[0] * (dy + count_[1] * static_cast<std::int64_t>(dz)),
                                      spacing * std::sqrt(static_cast<double>(dx * dx + dy * dy + dz * dz))});
                }
            }
        }
    }

    std::vector<std::int64_t> cell;
    std::vector<double> depth;
    std::size_t size() const { return cell.size(); }
    double spacing() const { return spacing_; }
    Vec3 place(Index n) const { return place_of(cell[static_cast<std::size_t>(n)]); }

    template <class Body>
    void each_neighbour(Index n, Body&& body) const {
        const std::int64_t here = cell[static_cast<std::size_t>(n)];
        for (const Step& step : steps_) {
            const Index m = number_[static_cast<std::size_t>(here + step.offset)];
            if (m >= 0) body(m, step.length);
        }
    }

    /// Lattice points within `radius` of point n.
    template <class Body>
    void each_within(Index n, double radius, Body&& body) const {
        std::int64_t c[3];
        split(cell[static_cast<std::size_t>(n)], c);
        const auto reach = static_cast<std::int64_t>(std::ceil(radius / spacing_));
        for (std::int64_t z = -reach; z <= reach; ++z) {
            for (std::int64_t y = -reach; y <= reach; ++y) {
                for (std::int64_t x = -reach; x <= reach; ++x) {
                    if (static_cast<double>(x * x + y * y + z * z) * spacing_ * spacing_ > radius * radius) continue;
                    const Index m = at(c[0] + x, c[1] + y, c[2] + z);
                    if (m >= 0) body(m);
                }
            }
        }
    }

private:
    struct Step {
        std::int64_t offset;
        double length;
    };
    Vec3 low_;
    double spacing_;
    std::array<std::int64_t, 3> count_{};
    std::vector<Index> number_;
    std::vector<Step> steps_;

    void split(std::int64_t i, std::int64_t* c) const {
        c[0] = i % count_[0];
        c[1] = i / count_[0] % count_[1];
        c[2] = i / (count_[0] * count_[1]);
    }
    Vec3 place_of(std::int64_t i) const {
        std::int64_t c[3];
        split(i, c);
        return low_ + spacing_ * Vec3(static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2]));
    }
    Index at(std::int64_t x, std::int64_t y, std::int64_t z) const {
        if (x < 0 || y < 0 || z < 0 || x >= count_[0] || y >= count_[1] || z >= count_[2]) return -1;
        return number_[static_cast<std::size_t>(x + count_[0] * (y + count_[1] * z))];
    }
};

struct Distances {
    std::vector<double> value;
    std::vector<Index> previous;
    std::vector<Index> source;
};

/// Dijkstra from all sources; ridge: cost = length / depth^2, else length alone.
Distances spread(const Lattice& lattice, const std::vector<Index>& sources, bool ridge) {
    Distances d;
    d.value.assign(lattice.size(), 1e300);
    d.previous.assign(lattice.size(), -1);
    d.source.assign(lattice.size(), -1);
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Index s : sources) {
        d.value[static_cast<std::size_t>(s)] = 0.0;
        d.source[static_cast<std::size_t>(s)] = s;
        queue.emplace(0.0, s);
    }
    while (!queue.empty()) {
        const double value = queue.top().first;
        const Index n = queue.top().second;
        queue.pop();
        if (value > d.value[static_cast<std::size_t>(n)]) continue;
        lattice.each_neighbour(n, [&](Index m, double length) {
            const auto i = static_cast<std::size_t>(m);
            const double cost = ridge ? length / (lattice.depth[i] * lattice.depth[i]) : length;
            const double next = value + cost;
            if (next >= d.value[i]) return;
            d.value[i] = next;
            d.previous[i] = n;
            d.source[i] = d.source[static_cast<std::size_t>(n)];
            queue.emplace(next, m);
        });
    }
    return d;
}

Index farthest(const Distances& d, const std::vector<std::uint8_t>& taken) {
    Index best = -1;
    double value = -1.0;
    for (std::size_t i = 0; i < d.value.size(); ++i) {
        if (d.value[i] > 1e299 || (!taken.empty() && taken[i] != 0) || d.value[i] <= value) continue;
        value = d.value[i];
        best = static_cast<Index>(i);
    }
    return best;
}

/// The skeleton while it grows: lattice points and the links between them.
struct Growing {
    std::map<Index, std::set<Index>> links;
    void add(const std::vector<Index>& path) {
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            links[path[i]].insert(path[i + 1]);
            links[path[i + 1]].insert(path[i]);
        }
    }
    bool has(Index n) const { return links.count(n) != 0; }
    std::vector<Index> points() const {
        std::vector<Index> out;
        for (const auto& [n, unused] : links) out.push_back(n);
        return out;
    }
    /// Is there a way along the links from a to b no longer than `limit` mm?
    bool near(const Lattice& lattice, Index a, Index b, double limit) const {
        std::map<Index, double> best = {{a, 0.0}};
        using Entry = std::pair<double, Index>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
        queue.emplace(0.0, a);
        while (!queue.empty()) {
            const auto [d, n] = queue.top();
            queue.pop();
            if (n == b) return true;
            if (d > best[n] || d > limit) continue;
            for (const Index m : links.at(n)) {
                const double next = d + (lattice.place(n) - lattice.place(m)).norm();
                const auto [it, fresh] = best.try_emplace(m, next);
                if (!fresh && next >= it->second) continue;
                it->second = next;
                if (next <= limit) queue.emplace(next, m);
            }
        }
        return false;
    }
};

void grow_tree(const Lattice& lattice, Index root, Growing& skeleton) {
    const Distances far = spread(lattice, {root}, false);
    const Distances ridge = spread(lattice, {root}, true);
    std::vector<std::uint8_t> taken(lattice.size(), 0);
    for (std::size_t i = 0; i < lattice.size(); ++i) taken[i] = far.value[i] > 1e299 ? 1 : 0;
    for (;;) {
        const Index end = farthest(far, taken);
        if (end < 0) return;
        std::vector<Index> path = {end};
        while (path.back() != root && !skeleton.has(path.back()))
            path.push_back(ridge.previous[static_cast<std::size_t>(path.back())]);
        double outside = 0.0;  // length of the path beyond the lumina that are taken already
        for (std::size_t i = 0; i + 1 < path.size(); ++i) {
            if (taken[static_cast<std::size_t>(path[i])] == 0)
                outside += (lattice.place(path[i]) - lattice.place(path[i + 1])).norm();
        }
        // a bump on the wall is no vessel
        const bool vessel = skeleton.links.empty() || outside > shortest_branch;
        if (vessel) {
            skeleton.add(path);
            for (const Index n : path) {
                const double reach = 1.5 * lattice.depth[static_cast<std::size_t>(n)] + 2.5 * lattice.spacing();
                lattice.each_within(n, reach, [&](Index m) { taken[static_cast<std::size_t>(m)] = 1; });
            }
        }
        taken[static_cast<std::size_t>(end)] = 1;
        if (!vessel)
            lattice.each_within(end, std::max(2.0 * lattice.spacing(), 0.7 * outside),
                                [&](Index m) { taken[static_cast<std::size_t>(m)] = 1; });
    }
}

void close_loops(const Lattice& lattice, Growing& skeleton) {
    for (std::size_t round = 0; round < most_loops; ++round) {
        const Distances d = spread(lattice, skeleton.points(), true);
        struct Contact {
            double depth;
            Index p, q;
        };
        std::map<std::pair<Index, Index>, Contact> contacts;  // the deepest for each pair of skeleton points
        for (std::size_t i = 0; i < lattice.size(); ++i) {
            if (d.source[i] < 0) continue;
            const auto p = static_cast<Index>(i);
            lattice.each_neighbour(p, [&](Index q, double) {
                const auto j = static_cast<std::size_t>(q);
                if (q < p || d.source[j] < 0 || d.source[i] == d.source[j]) return;
                const double depth = std::min(lattice.depth[i], lattice.depth[j]);
                const auto key = std::minmax(d.source[i], d.source[j]);
                if (depth < 1.2 * lattice.spacing()) return;
                if ((lattice.place(key.first) - lattice.place(key.second)).norm() < 2.0 * lattice.spacing()) return;
                const auto [it, fresh] = contacts.try_emplace(key, Contact{depth, p, q});
                if (!fresh && depth > it->second.depth) it->second = {depth, p, q};
            });
        }
        std::vector<std::pair<Contact, std::pair<Index, Index>>> sorted;
        sorted.reserve(contacts.size());
        for (const auto& [key, contact] : contacts) sorted.emplace_back(contact, key);
        std::stable_sort(sorted.begin(), sorted.end(),
                         [](const auto& a, const auto& b) { return a.first.depth > b.first.depth; });
        bool added = false;
        for (const auto& [contact, key] : sorted) {
            const double reach = 12.0 + 4.0 * (lattice.depth[static_cast<std::size_t>(key.first)] +
                                               lattice.depth[static_cast<std::size_t>(key.second)]);
            if (skeleton.near(lattice, key.first, key.second, reach)) continue;
            std::vector<Index> path;
            for (Index n = contact.p; n >= 0; n = d.previous[static_cast<std::size_t>(n)]) path.push_back(n);
            std::reverse(path.begin(), path.end());
            for (Index n = contact.q; n >= 0; n = d.previous[static_cast<std::size_t>(n)]) path.push_back(n);
            skeleton.add(path);
            added = true;
            break;
        }
        if (!added) return;
    }
}

/// Takes off free ends that hardly leave the lumen of what they join.
void prune(const Lattice& lattice, Growing& skeleton) {
    for (bool again = true; again;) {
        again = false;
        for (const Index end : skeleton.points()) {
            const auto it = skeleton.links.find(end);
            if (it == skeleton.links.end() || it->second.size() != 1) continue;
            std::vector<Index> path = {end, *it->second.begin()};
            double length = (lattice.place(path[0]) - lattice.place(path[1])).norm();
            while (skeleton.links.at(path.back()).size() == 2) {
                const auto& links = skeleton.links.at(path.back());
                const Index next = *links.begin() == path[path.size() - 2] ? *links.rbegin() : *links.begin();
                length += (lattice.place(path.back()) - lattice.place(next)).norm();
                path.push_back(next);
            }
            if (skeleton.links.at(path.back()).size() < 3) continue;  // the only vessel
            const double room = lattice.depth[static_cast<std::size_t>(path.back())];
            if (length > 1.3 * room + shortest_branch) continue;
            skeleton.links.at(path.back()).erase(path[path.size() - 2]);
            for (std::size_t i = 0; i + 1 < path.size(); ++i) skeleton.links.erase(path[i]);
            again = true;
        }
    }
}

/// Mean of the neighbours along the chain, ends held, as often as the lumen is lattice spacings wide.
void smooth(std::vector<Vec3>& points, int times) {
    std::vector<Vec3> next = points;
    for (int k = 0; k < times; ++k) {
        for (std::size_t i = 1; i + 1 < points.size(); ++i)
            next[i] = 0.5 * points[i] + 0.25 * (points[i - 1] + points[i + 1]);
        points.swap(next);
    }
}

Curve curve_of(const std::vector<Vec3>& points, const DistanceGrid& distance) {
    Curve c;
    for (const Vec3& p : points) {
        c.arc.push_back(c.position.empty() ? 0.0 : c.arc.back() + (p - c.position.back()).norm());
        c.position.push_back(p);
        c.radius.push_back(std::max(0.8 * distance.voxel(), -distance.value(p)));
    }
    return c;
}

/// At a free end the wall is near because the vessel ends: the radius there is that of a little further inside.
void mend_free_end(Curve& c, bool at_front) {
    const double length = c.length();
    double reach = 0.0;
    for (std::size_t k = 0; k < c.arc.size(); ++k) {
        const std::size_t i = at_front ? k : c.arc.size() - 1 - k;
        const double inside = at_front ? c.arc[i] : length - c.arc[i];
        if (inside > 0.5 * length || (inside > 4.0 && c.radius[i] < inside))
            break;  // the side wall is nearer than the end
        reach = inside;
    }
    const double r = c.radius_at(at_front ? reach : length - reach);
    for (std::size_t i = 0; i < c.arc.size(); ++i) {
        if ((at_front ? c.arc[i] : length - c.arc[i]) < reach) c.radius[i] = std::max(c.radius[i], r);
    }
}

}  // namespace

Skeleton find_skeleton(const DistanceGrid& distance, const Vec3& low, const Vec3& high, double spacing,
                       const Workers& workers) {
    Skeleton out;
    const Lattice lattice(distance, low, high, spacing, workers);
    if (lattice.size() < 2) return out;
    const auto deepest =
        static_cast<Index>(std::max_element(lattice.depth.begin(), lattice.depth.end()) - lattice.depth.begin());
    const Index root = farthest(spread(lattice, {deepest}, false), {});
    Growing skeleton;
    grow_tree(lattice, root, skeleton);
    prune(lattice, skeleton);
    close_loops(lattice, skeleton);
    prune(lattice, skeleton);

    std::map<Index, Index> joint;  // lattice points with other than two links
    for (const auto& [n, links] : skeleton.links) {
        if (links.size() != 2) {
            joint.emplace(n, static_cast<Index>(out.degree.size()));
            out.degree.push_back(static_cast<int>(links.size()));
        }
    }
    std::set<std::pair<Index, Index>> walked;
    for (const auto& [start, id] : joint) {
        for (const Index first : skeleton.links.at(start)) {
            if (walked.count({start, first}) != 0) continue;
            std::vector<Index> chain = {start, first};
            while (joint.count(chain.back()) == 0) {
                const auto& links = skeleton.links.at(chain.back());
                const Index before = chain[chain.size() - 2];
                chain.push_back(*links.begin() == before ? *links.rbegin() : *links.begin());
            }
            walked.insert({start, first});
            walked.insert({chain.back(), chain[chain.size() - 2]});
            std::vector<Vec3> points;
            double room = 0.0;
            for (const Index n : chain) {
                points.push_back(lattice.place(n));
                room = std::max(room, lattice.depth[static_cast<std::size_t>(n)]);
            }
            const double width = room / spacing;
            smooth(points, static_cast<int>(std::clamp(width * width, 8.0, 200.0)));
            Curve c = curve_of(points, distance);
            const Index last = joint.at(chain.back());
            if (out.degree[static_cast<std::size_t>(id)] == 1) mend_free_end(c, true);
            if (out.degree[static_cast<std::size_t>(last)] == 1) mend_free_end(c, false);
            out.chains.push_back(std::move(c));
            out.joints.push_back({id, last});
        }
    }
    out.loops = static_cast<int>(out.chains.size()) - static_cast<int>(out.degree.size()) + 1;
    return out;
}

}  // namespace cathlab
