#include "task/force_map.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "anatomy/model.h"
#include "contact/contact_set.h"
#include "core/csv.h"
#include "core/deterministic_math.h"
#include "core/errors.h"
#include "core/units.h"
#include "world/step_settings.h"

namespace cathlab {

namespace {

constexpr double sector_deg = 360.0 / UnrolledForces::sectors;
constexpr std::size_t most_rows = 1000;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

std::string exact(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return {text, end};
}

/// The centre-line's nodes from the heart, or the end that is farthest, to the first entry site.
std::vector<Index> whole_way(const AnatomyModel& anatomy) {
    const CentrelineGraph& graph = anatomy.centreline;
    if (anatomy.entries.empty()) return {};
    const Index entry = anatomy.entries.front().node;
    if (anatomy.annulus) return graph.path(graph.nearest(anatomy.annulus->pose.position), entry);
    std::vector<Index> longest;
    const auto neighbours = graph.adjacency();
    for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
        if (neighbours[i].size() != 1) continue;
        std::vector<Index> path = graph.path(static_cast<Index>(i), entry);
        if (graph.length(path) > graph.length(longest)) longest = std::move(path);
    }
    return longest;
}

struct Station {
    double arc_mm = 0.0;
    Vec3 front, left;  // across the way
};

/// Frames carried up from the lower end; arcs counted from the upper one.
std::vector<Station> stations(const CentrelineGraph& graph, const std::vector<Index>& way) {
    std::vector<Station> out(way.size());
    const auto node = [&](std::size_t k) { return graph.nodes[at(way[k])].position; };
    for (std::size_t k = 1; k < way.size(); ++k) out[k].arc_mm = out[k - 1].arc_mm + (node(k) - node(k - 1)).norm();
    Vec3 before = Vec3::UnitZ(), front = -Vec3::UnitY();
    for (std::size_t k = way.size(); k-- > 0;) {
        const std::size_t other = k > 0 ? k - 1 : 1;
        const Vec3 up = (k > 0 ? 1.0 : -1.0) * (node(other) - node(k)).normalized();
        front = det::rotation_between(before, up) * front;
        front = (front - up * up.dot(front)).normalized();
        out[k].front = front;
        out[k].left = front.cross(up);
        before = up;
    }
    return out;
}

}  // namespace

void UnrolledForces::add(const UnrolledForces& other) {
    impulse_ns.resize(std::max(impulse_ns.size(), other.impulse_ns.size()), 0.0);
    for (std::size_t i = 0; i < other.impulse_ns.size(); ++i) impulse_ns[i] += other.impulse_ns[i];
}

std::string force_map_csv(const UnrolledForces& forces) {
    std::string out = "along_mm,angle_deg,impulse_ns\n";
    for (std::size_t i = 0; i < forces.impulse_ns.size(); ++i) {
        if (forces.impulse_ns[i] <= 0.0 && i + 1 < forces.impulse_ns.size()) continue;  // the last one tells the length
        const auto row = static_cast<double>(i / UnrolledForces::sectors);
        const auto sector = static_cast<double>(i % UnrolledForces::sectors);
        out += exact((row + 0.5) * UnrolledForces::along_mm) + "," + exact((sector + 0.5) * sector_deg) + "," +
               exact(forces.impulse_ns[i]) + "\n";
    }
    return out;
}

UnrolledForces parse_force_map(std::string_view text, const std::string& path) {
    UnrolledForces out;
    CsvLines lines(text);
    if (!lines.next() || lines.text() != "along_mm,angle_deg,impulse_ns")
        throw UserError(path + ": the first line must be along_mm,angle_deg,impulse_ns");
    while (lines.next()) {
        const auto cells = lines.cells();
        const auto number = [&](std::size_t k) { return k < cells.size() ? finite_number(cells[k]) : std::nullopt; };
        const auto along = number(0), angle = number(1), impulse = number(2);
        const double most_mm = static_cast<double>(most_rows) * UnrolledForces::along_mm;
        if (cells.size() != 3 || !along || !angle || !impulse || *along < 0.0 || *along >= most_mm || *angle < 0.0 ||
            *angle >= 360.0 || *impulse < 0.0)
            throw UserError(path + ":" + std::to_string(lines.number()) +
                            ": three numbers are wanted: along_mm from 0 to " + std::to_string(most_mm) +
                            ", angle_deg from 0 to below 360, impulse_ns from 0 up");
        const auto cell = static_cast<std::size_t>(*along / UnrolledForces::along_mm) * UnrolledForces::sectors +
                          static_cast<std::size_t>(*angle / sector_deg);
        if (cell >= out.impulse_ns.size())
            out.impulse_ns.resize((cell / UnrolledForces::sectors + 1) * UnrolledForces::sectors, 0.0);
        out.impulse_ns[cell] += *impulse;
    }
    return out;
}

ForceMap::ForceMap(const World& world) {
    const AnatomyModel& anatomy = **world.first<Shared<AnatomyModel>>();
    for (const Region& region : anatomy.regions) regions_.push_back({region.name});
    const std::vector<Triangle>& triangles = anatomy.lumen.triangles;
    impulse_mns_.assign(triangles.size(), 0.0);
    cell_.assign(triangles.size(), -1);
    const std::vector<Index> way = whole_way(anatomy);
    if (way.size() < 2) return;
    const CentrelineGraph& graph = anatomy.centreline;
    const std::vector<Station> station = stations(graph, way);
    rows_ = static_cast<std::size_t>(station.back().arc_mm / UnrolledForces::along_mm) + 1;
    std::vector<std::ptrdiff_t> place(graph.nodes.size(), -1);  // of a node on the way
    for (std::size_t k = 0; k < way.size(); ++k) place[at(way[k])] = static_cast<std::ptrdiff_t>(k);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        Vec3 middle = Vec3::Zero();
        for (const Index v : triangles[t]) middle += anatomy.lumen.vertices[at(v)] / 3.0;
        const Index node = graph.nearest(middle);
        if (place[at(node)] < 0) continue;
        const Station& s = station[static_cast<std::size_t>(place[at(node)])];
        const Vec3 out = middle - graph.nodes[at(node)].position;
        double angle = det::atan2(s.left.dot(out), s.front.dot(out)) * 180.0 / units::pi;
        if (angle < 0.0) angle += 360.0;
        const int sector = std::min(static_cast<int>(angle / sector_deg), UnrolledForces::sectors - 1);
        cell_[t] = static_cast<int>(s.arc_mm / UnrolledForces::along_mm) * UnrolledForces::sectors + sector;
    }
}

void ForceMap::add(const World& world, double dt) {
    const ContactSet& contacts = *world.first<ContactSet>();
    const auto rows = contacts.rows();
    const auto wall = contacts.wall_rows();
    for (RegionSum& region : regions_) region.now_mn = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double force = rows[i].multiplier;
        if (force <= 0.0) continue;
        impulse_mns_[at(wall[i].triangle)] += force * dt;
        regions_[at(wall[i].region)].now_mn += force;
    }
    for (RegionSum& region : regions_) {
        region.max_mn = std::max(region.max_mn, region.now_mn);
        region.impulse_mns += region.now_mn * dt;
        if (region.now_mn > 0.0) region.contact_s += dt;
    }
}

std::string ForceMap::regions_csv() const {
    std::vector<const RegionSum*> touched;
    for (const RegionSum& region : regions_)
        if (region.contact_s > 0.0) touched.push_back(&region);
    std::sort(touched.begin(), touched.end(), [](auto* a, auto* b) { return a->name < b->name; });
    std::string out = "region,force_max_n,impulse_ns,contact_s\n";
    for (const RegionSum* r : touched)
        out += r->name + "," + exact(r->max_mn / units::newton) + "," + exact(r->impulse_mns / units::newton) + "," +
               exact(r->contact_s) + "\n";
    return out;
}

UnrolledForces ForceMap::unrolled() const {
    UnrolledForces out;
    out.impulse_ns.assign(rows_ * UnrolledForces::sectors, 0.0);
    for (std::size_t t = 0; t < cell_.size(); ++t)
        if (cell_[t] >= 0) out.impulse_ns[static_cast<std::size_t>(cell_[t])] += impulse_mns_[t] / units::newton;
    return out;
}

}  // namespace cathlab
