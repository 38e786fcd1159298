#include "scene/entry.h"

#include "core/deterministic_math.h"
#include "core/errors.h"

namespace cathlab {

namespace {

// How far into the vessel a guiding catheter's mouth stands.
constexpr double engaged_mm = 3.0;

double length_of(const std::vector<Vec3>& line) {
    double length = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
    return length;
}

std::vector<Vec3> points_of(const CentrelineGraph& graph, const std::vector<Index>& path) {
    std::vector<Vec3> out;
    for (const Index node : path) out.push_back(graph.nodes[static_cast<std::size_t>(node)].position);
    return out;
}

/// The longest of the paths from a node to the free ends, of those that begin along `towards`.
std::vector<Index> to_the_farthest_end(const CentrelineGraph& graph, Index from, const Vec3& at, const Vec3& towards) {
    std::vector<Index> path;
    double longest = 0.0;
    const auto neighbours = graph.adjacency();
    for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
        if (neighbours[i].size() != 1) continue;
        std::vector<Index> candidate = graph.path(from, static_cast<Index>(i));
        const double length = graph.length(candidate);
        if (length <= longest) continue;
        const std::size_t second = std::min<std::size_t>(3, candidate.size() - 1);
        const Vec3 first = graph.nodes[static_cast<std::size_t>(candidate[second])].position - at;
        if (first.dot(towards) <= 0.0) continue;
        longest = length;
        path = std::move(candidate);
    }
    return path;
}

// What lies beyond the mouth.
std::vector<Vec3> beyond(const Pose& mouth, const std::vector<Vec3>& line) {
    std::vector<Vec3> points{mouth.position};
    const Vec3 inward = mouth.orientation * Vec3::UnitZ();
    for (const Vec3& p : line)
        if ((p - mouth.position).dot(inward) > 1.0 || points.size() > 1) points.push_back(p);
    return points;
}

WayIn from_entry(const AnatomyModel& anatomy, const EntrySite& entry) {
    const CentrelineGraph& graph = anatomy.centreline;
    const Vec3 inward = entry.pose.orientation * Vec3::UnitZ();
    const std::vector<Index> path = anatomy.annulus
                                        ? graph.path(entry.node, graph.nearest(anatomy.annulus->pose.position))
                                        : to_the_farthest_end(graph, entry.node, entry.pose.position, inward);
    return {entry, beyond(entry.pose, points_of(graph, path)), {}};
}

WayIn from_guide(const AnatomyModel& anatomy, const Landmark& landmark, const SceneDevice& device) {
    const CentrelineGraph& graph = anatomy.centreline;
    const Vec3 at = landmark.pose.position;
    const Vec3 along = landmark.pose.orientation * Vec3::UnitZ();
    const std::vector<Vec3> line = points_of(graph, to_the_farthest_end(graph, landmark.node, at, along));
    std::size_t first = 0;
    while (first < line.size() && (line[first] - at).dot(along) < engaged_mm) ++first;
    if (first + 1 >= line.size())
        throw UserError(device.where, "entry: no vessel leads on from the landmark '" + landmark.name + "'");
    WayIn out;
    out.entry = {landmark.name,
                 {line[first], det::rotation_between(Vec3::UnitZ(), (line[first + 1] - line[first]).normalized())},
                 landmark.radius_mm,
                 landmark.node};
    out.points = beyond(out.entry.pose, line);
    out.guide = {line[first], at};
    if (!anatomy.entries.empty()) {
        const std::vector<Vec3> back = points_of(graph, graph.path(landmark.node, anatomy.entries.front().node));
        out.guide.insert(out.guide.end(), back.begin(), back.end());
    }
    return out;
}

}  // namespace

WayIn find_way_in(const AnatomyModel& anatomy, const SceneDevice& device, bool may_guide) {
    std::vector<std::string> names;
    for (const EntrySite& entry : anatomy.entries) {
        if (entry.name == device.entry) return from_entry(anatomy, entry);
        names.push_back(entry.name);
    }
    std::string guides;
    if (may_guide && !anatomy.landmarks.empty()) {
        std::vector<std::string> landmarks;
        for (const Landmark& landmark : anatomy.landmarks) {
            if (landmark.name == device.entry) return from_guide(anatomy, landmark, device);
            landmarks.push_back(landmark.name);
        }
        guides = "; out of a guiding catheter, a wire comes in at a landmark too: " + comma_list(landmarks);
        names.insert(names.end(), landmarks.begin(), landmarks.end());
    }
    std::vector<std::string> entries;
    for (const EntrySite& entry : anatomy.entries) entries.push_back(entry.name);
    throw UserError(device.where, "the anatomy has no entry site '" + device.entry + "'; it has " +
                                      comma_list(entries) + guides + did_you_mean(device.entry, names));
}

void check_width(const WayIn& way, double radius_mm, const SceneDevice& device) {
    if (radius_mm >= way.entry.radius_mm)
        throw UserError(device.where, "the device is " + std::to_string(2.0 * radius_mm) +
                                          " mm wide and the vessel at '" + way.entry.name + "' only " +
                                          std::to_string(2.0 * way.entry.radius_mm) + " mm");
}

void check_insertion(const WayIn& way, double length_mm, const SceneDevice& device) {
    const double room = length_of(way.points);
    if (device.insertion_mm > room)
        throw UserError(device.where, "insertion_mm: found " + std::to_string(device.insertion_mm) +
                                          ", but the way in from '" + way.entry.name + "' is " + std::to_string(room) +
                                          " mm long");
    if (device.insertion_mm >= length_mm)
        throw UserError(device.where, "insertion_mm: found " + std::to_string(device.insertion_mm) + ", but '" +
                                          device.device + "' is only " + std::to_string(length_mm) + " mm long");
}

}  // namespace cathlab
