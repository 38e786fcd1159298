#include "calibrate/stations.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "calibrate/station_piece.h"
#include "core/errors.h"

namespace cathlab {
namespace {

constexpr double aortic_radius_mm = 7.0;  // narrower regions have no station of their own accord
constexpr double direction_mm = 4.0;      // over which the centre-line's direction is taken

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

std::string text(double mm) {
    return std::to_string(static_cast<long>(std::lround(mm))) + " mm";
}

class Finder {
public:
    Finder(const AnatomyModel& anatomy, const SceneRig& rig)
        : anatomy_(anatomy), rig_(rig), neighbours_(anatomy.centreline.adjacency()) {}

    std::vector<Station> all() const {
        std::vector<Station> out;
        if (rig_.stations.empty()) {
            for (std::size_t r = 0; r < anatomy_.regions.size(); ++r) add_own(static_cast<Index>(r), out);
            if (out.empty())
                throw UserError(rig_.where, "no region of the anatomy '" + anatomy_.name +
                                                "' has room for a station with a lumen of " + text(aortic_radius_mm) +
                                                " radius or more; [[rig.station]] names others");
            return out;
        }
        for (const SceneRigStation& wanted : rig_.stations) {
            Station station = named(wanted);
            for (const Station& other : out) {
                if (other.name == station.name)
                    throw UserError(wanted.where, "a second station named '" + station.name + "'");
                if (overlap(station, other))
                    throw UserError(wanted.where, "'" + station.name + "' stands too near to '" + other.name +
                                                      "': both would push the same wall; " +
                                                      text(needed_apart(station, other)) + " or more are wanted");
            }
            out.push_back(std::move(station));
        }
        return out;
    }

private:
    const CentrelineNode& node(Index i) const { return anatomy_.centreline.nodes[at(i)]; }

    static double needed_apart(const Station& a, const Station& b) {
        return station_loaded_radii * (a.radius_mm + b.radius_mm);
    }

    // Along the vessel, not through the air: the arch comes near to itself.
    static bool overlap(const Station& a, const Station& b) {
        for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
            const Foot foot = foot_on(*one, other->place);
            if (!foot.beyond && foot.across < one->radius_mm && std::fabs(foot.arc) < needed_apart(a, b)) return true;
        }
        return false;
    }

    std::vector<std::string> names_of_regions() const {
        std::vector<std::string> out;
        for (const Region& region : anatomy_.regions) out.push_back(region.name);
        return out;
    }

    Station named(const SceneRigStation& wanted) const {
        const SourcePlace where = wanted.where;
        if (wanted.region.empty() == wanted.landmark.empty())
            throw UserError(where, "'" + wanted.name + "' wants either a region or a landmark of the anatomy");
        Station station;
        if (!wanted.landmark.empty()) {
            if (wanted.place_mm)
                throw UserError(
                    where, "place_mm runs along a region; the landmark of '" + wanted.name + "' is a place by itself");
            std::vector<std::string> names;
            const Landmark* found = nullptr;
            for (const Landmark& landmark : anatomy_.landmarks) {
                names.push_back(landmark.name);
                if (landmark.name == wanted.landmark) found = &landmark;
            }
            if (!found)
                throw UserError(where, "landmark: the anatomy has no '" + wanted.landmark + "'; it has " +
                                           comma_list(names) + did_you_mean(wanted.landmark, names));
            station = at_landmark(*found, where);
        } else {
            const std::vector<std::string> names = names_of_regions();
            const auto it = std::find(names.begin(), names.end(), wanted.region);
            if (it == names.end())
                throw UserError(where, "region: the anatomy has no '" + wanted.region + "'; it has " +
                                           comma_list(names) + did_you_mean(wanted.region, names));
            const std::vector<Index> way = way_through(static_cast<Index>(it - names.begin()));
            if (way.size() < 2)
                throw UserError(where, "region: '" + wanted.region + "' has no centre-line along which to stand");
            const double length = anatomy_.centreline.length(way);
            if (wanted.place_mm && *wanted.place_mm > length)
                throw UserError(where, "place_mm: found " + std::to_string(*wanted.place_mm) + "; '" + wanted.region +
                                           "' is " + text(length) + " long");
            station = along(way, wanted.place_mm.value_or(0.5 * length));
        }
        station.name = wanted.name;
        if (!(station.radius_mm > 0.0))
            throw UserError(where, "the radius of the lumen at '" + station.name + "' is " +
                                       std::to_string(station.radius_mm) + " mm; there is nothing to push");
        const double wish = station_loaded_radii * station.radius_mm;
        if (-station.arc.front() < wish || station.arc.back() < wish)
            throw UserError(where, "'" + station.name + "' has " + text(-station.arc.front()) + " and " +
                                       text(station.arc.back()) + " of vessel to its sides; the wall is pushed over " +
                                       text(wish) + " (two and a half radii of the lumen) to either side");
        return station;
    }

    void add_own(Index region, std::vector<Station>& out) const {
        const std::vector<Index> way = way_through(region);
        if (way.size() < 2) return;
        Station station = along(way, 0.5 * anatomy_.centreline.length(way));
        const double wish = station_loaded_radii * station.radius_mm;
        if (station.radius_mm < aortic_radius_mm || -station.arc.front() < wish || station.arc.back() < wish) return;
        if (std::any_of(out.begin(), out.end(), [&](const Station& other) { return overlap(station, other); })) return;
        station.name = anatomy_.regions[at(region)].name;
        out.push_back(std::move(station));
    }

    /// The longest way along a region's centre-line, from the end that the anatomy names first.
    std::vector<Index> way_through(Index region) const {
        std::vector<Index> nodes;
        for (std::size_t i = 0; i < anatomy_.centreline.nodes.size(); ++i)
            if (node(static_cast<Index>(i)).region == region) nodes.push_back(static_cast<Index>(i));
        if (nodes.empty()) return {};
        std::vector<Index> way = farthest(farthest(nodes.front(), region).back(), region);
        if (way.back() < way.front()) std::reverse(way.begin(), way.end());
        return way;
    }

    /// The way to the node of the region that is farthest from a node of it.
    std::vector<Index> farthest(Index from, Index region) const {
        std::vector<double> distance(anatomy_.centreline.nodes.size(), -1.0);
        std::vector<Index> before(distance.size(), -1);
        std::set<std::pair<double, Index>> open{{0.0, from}};
        distance[at(from)] = 0.0;
        Index last = from;
        while (!open.empty()) {
            const Index i = open.begin()->second;
            open.erase(open.begin());
            if (distance[at(i)] > distance[at(last)]) last = i;
            for (const Index j : neighbours_[at(i)]) {
                if (node(j).region != region) continue;
                const double d = distance[at(i)] + (node(i).position - node(j).position).norm();
                if (distance[at(j)] >= 0.0 && distance[at(j)] <= d) continue;
                open.erase({distance[at(j)], j});
                distance[at(j)] = d;
                before[at(j)] = i;
                open.insert({d, j});
            }
        }
        std::vector<Index> way;
        for (Index i = last; i >= 0; i = before[at(i)]) way.push_back(i);
        std::reverse(way.begin(), way.end());
        return way;
    }

    Station along(const std::vector<Index>& way, double place_mm) const {
        double done = 0.0;
        for (std::size_t k = 1;; ++k) {
            const double piece = (node(way[k]).position - node(way[k - 1]).position).norm();
            if (done + piece >= place_mm || k + 1 == way.size())
                return between(way[k - 1], way[k], std::clamp((place_mm - done) / piece, 0.0, 1.0));
            done += piece;
        }
    }

    Station at_landmark(const Landmark& landmark, const SourcePlace& where) const {
        const std::vector<Index>& next = neighbours_[at(landmark.node)];
        if (next.empty()) throw UserError(where, "landmark: '" + landmark.name + "' stands on no centre-line");
        return between(landmark.node, onward(-1, landmark.node), 0.0);
    }

    /// A station on the edge from a to b, with its stretch of centre-line.
    Station between(Index a, Index b, double part) const {
        Station station;
        const Vec3 place = node(a).position + part * (node(b).position - node(a).position);
        station.place = place;
        station.radius_mm = node(a).radius + part * (node(b).radius - node(a).radius);
        station.region = anatomy_.regions[at(node(part < 0.5 ? a : b).region)].name;
        const double reach = station_kept_radii * station.radius_mm + direction_mm;
        std::vector<Vec3> back = walk(place, b, a, reach);
        const std::vector<Vec3> fore = walk(place, a, b, reach);
        std::reverse(back.begin(), back.end());
        station.path = std::move(back);
        const std::size_t middle = station.path.size();
        station.path.push_back(place);
        station.path.insert(station.path.end(), fore.begin(), fore.end());
        station.arc.assign(station.path.size(), 0.0);
        for (std::size_t k = middle + 1; k < station.path.size(); ++k)
            station.arc[k] = station.arc[k - 1] + (station.path[k] - station.path[k - 1]).norm();
        for (std::size_t k = middle; k-- > 0;)
            station.arc[k] = station.arc[k + 1] - (station.path[k + 1] - station.path[k]).norm();
        station.axis = (on_path(station, direction_mm) - on_path(station, -direction_mm)).normalized();
        const auto add_region = [&](Index region) {
            if (std::find(station.regions.begin(), station.regions.end(), region) == station.regions.end())
                station.regions.push_back(region);
        };
        // Of the nodes that lie on the stretch; the path's points are theirs.
        for (const CentrelineNode& n : anatomy_.centreline.nodes)
            for (std::size_t k = 0; k < station.path.size(); ++k)
                if (std::fabs(station.arc[k]) <= station_loaded_radii * station.radius_mm &&
                    n.position == station.path[k])
                    add_region(n.region);
        add_region(node(a).region);
        add_region(node(b).region);
        return station;
    }

    static Vec3 on_path(const Station& station, double arc) {
        for (std::size_t k = 1; k < station.path.size(); ++k)
            if (station.arc[k] >= arc) {
                const double t = (arc - station.arc[k - 1]) / (station.arc[k] - station.arc[k - 1]);
                return station.path[k - 1] + std::clamp(t, 0.0, 1.0) * (station.path[k] - station.path[k - 1]);
            }
        return station.path.back();
    }

    /// Nodes from `next` on, coming from `previous`, until the way from the place is longer than reach.
    std::vector<Vec3> walk(const Vec3& place, Index previous, Index next, double reach) const {
        constexpr double same_mm = 1e-6;
        std::vector<Vec3> out;
        double done = 0.0;
        Vec3 last = place;
        while (next >= 0 && done <= reach) {
            const double piece = (node(next).position - last).norm();
            if (piece > same_mm) {
                done += piece;
                last = node(next).position;
                out.push_back(last);
            }
            const Index after = onward(previous, next);
            previous = next;
            next = after;
        }
        return out;
    }

    /// How the vessel goes on from a node: in its own region if it can, else where it is wider a little further on.
    Index onward(Index previous, Index from) const {
        constexpr int further = 4;
        Index best = -1;
        std::pair<bool, double> most{false, -1.0};
        for (const Index first : neighbours_[at(from)]) {
            if (first == previous) continue;
            Index behind = from, ahead = first;
            for (int k = 0; k < further && neighbours_[at(ahead)].size() == 2; ++k) {
                const Index on =
                    neighbours_[at(ahead)][0] == behind ? neighbours_[at(ahead)][1] : neighbours_[at(ahead)][0];
                behind = ahead;
                ahead = on;
            }
            const std::pair<bool, double> found{node(first).region == node(from).region, node(ahead).radius};
            if (found <= most) continue;
            most = found;
            best = first;
        }
        return best;
    }

    const AnatomyModel& anatomy_;
    const SceneRig& rig_;
    std::vector<std::vector<Index>> neighbours_;
};

}  // namespace

StationWall station_wall(const AnatomyModel& anatomy, const SceneRig& rig) {
    StationWall out;
    out.anatomy = anatomy.name;
    out.regions = anatomy.regions;
    out.fixed = anatomy.fixed;
    out.stations = Finder(anatomy, rig).all();
    cut_piece(anatomy, rig, out);
    return out;
}

}  // namespace cathlab
