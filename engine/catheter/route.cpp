#include "catheter/route.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "core/check.h"
#include "core/errors.h"

namespace cathlab {
namespace {

std::size_t at(std::int64_t node) {
    return static_cast<std::size_t>(node);
}

double apart(const Vec3& a, const Vec3& b) {
    return std::sqrt((a - b).squaredNorm());
}

double distance_to_polyline(const Vec3& p, std::span<const Vec3> line) {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const Vec3 along = line[i + 1] - line[i];
        const double square = along.squaredNorm();
        const double t = square > 0.0 ? std::clamp((p - line[i]).dot(along) / square, 0.0, 1.0) : 0.0;
        best = std::min(best, (p - line[i] - t * along).squaredNorm());
    }
    if (line.size() == 1) best = (p - line[0]).squaredNorm();
    return std::sqrt(best);
}

bool on_route(const std::vector<std::int64_t>& route, Index node) {
    return std::find(route.begin(), route.end(), std::int64_t{node}) != route.end();
}

// Whether an end of the graph can be reached from `from` without crossing the route.
bool reaches_an_end(const RouteGraph& graph, const std::vector<std::int64_t>& route, Index from) {
    std::vector<char> seen(graph.neighbours.size(), 0);
    for (const std::int64_t node : route) seen[at(node)] = 1;
    std::vector<Index> open{from};
    seen[at(from)] = 1;
    while (!open.empty()) {
        const Index node = open.back();
        open.pop_back();
        if (graph.neighbours[at(node)].size() == 1) return true;
        for (const Index next : graph.neighbours[at(node)]) {
            if (seen[at(next)]) continue;
            seen[at(next)] = 1;
            open.push_back(next);
        }
    }
    return false;
}

// Neighbours that the route may go on to: not on it yet; of several, those that turn by less than 120 degrees and lead
// to an end of the graph by a way of their own (the other side of a loop, seen from where the loop closes, only leads
// back).
std::vector<Index> onward(const RouteGraph& graph, std::span<const Vec3> positions,
                          const std::vector<std::int64_t>& route) {
    if (route.size() == 1) return {graph.first};
    const std::size_t here = at(route.back());
    std::vector<Index> all, on;
    for (const Index next : graph.neighbours[here])
        if (!on_route(route, next)) all.push_back(next);
    if (all.size() < 2) return all;
    const Vec3 heading = (positions[here] - positions[at(route[route.size() - 2])]).normalized();
    for (const Index next : all) {
        const bool turns_back = (positions[at(next)] - positions[here]).normalized().dot(heading) < -0.5;
        if (!turns_back && reaches_an_end(graph, route, next)) on.push_back(next);
    }
    return on.empty() ? all : on;
}

// How far a branch, `reach` along it, lies from the guide.  Later forks go straight on.
double branch_distance(const RouteGraph& graph, std::span<const Vec3> positions, std::span<const Vec3> guide,
                       std::vector<std::int64_t> route, Index branch, double reach) {
    double gone = 0.0;
    Vec3 before = positions[at(route.back())];
    route.push_back(branch);
    Vec3 now = positions[at(branch)];
    gone += apart(before, now);
    while (gone < reach) {
        const Vec3 heading = (now - before).normalized();
        Index best = -1;
        double best_cosine = -2.0;
        for (const Index next : onward(graph, positions, route)) {
            const double cosine = (positions[at(next)] - now).normalized().dot(heading);
            if (cosine > best_cosine) {
                best_cosine = cosine;
                best = next;
            }
        }
        if (best < 0) break;
        before = now;
        now = positions[at(best)];
        gone += apart(before, now);
        route.push_back(best);
    }
    return distance_to_polyline(now, guide);
}

}  // namespace

RouteGraph build_route_graph(const CentrelineGraph& graph, Index entry, const Pose& mouth) {
    CATHLAB_CHECK(entry >= 0 && at(entry) < graph.nodes.size(), "the entry is a node of the graph");
    RouteGraph out;
    out.neighbours = graph.adjacency();
    out.entry = entry;
    out.radius.reserve(graph.nodes.size());
    for (const CentrelineNode& node : graph.nodes) out.radius.push_back(node.radius);
    const Vec3 inward = mouth.orientation * Vec3::UnitZ();
    double best = -2.0;
    for (const Index next : out.neighbours[at(entry)]) {
        const double cosine = (graph.nodes[at(next)].position - mouth.position).normalized().dot(inward);
        if (cosine > best) {
            best = cosine;
            out.first = next;
        }
    }
    if (out.first < 0)
        throw UserError("the entry site's node of the centre-line graph has no neighbour: no vessel leads on");
    return out;
}

void update_route(const RouteGraph& graph, std::span<const Vec3> positions, std::span<const Vec3> guide,
                  double base_arc_mm, std::vector<std::int64_t>& route, double lookahead_mm) {
    CATHLAB_CHECK(positions.size() == graph.neighbours.size(), "one position a node");
    if (route.size() < 2 || route.front() != graph.entry) route = {graph.entry, graph.first};
    const double wanted = std::max(base_arc_mm, 0.0) + lookahead_mm;
    double length = apart(positions[at(route[0])], positions[at(route[1])]);
    std::size_t kept = 2;
    while (kept < route.size() && length < wanted) {
        length += apart(positions[at(route[kept - 1])], positions[at(route[kept])]);
        ++kept;
    }
    route.resize(kept);
    while (length < wanted) {
        const std::vector<Index> choices = onward(graph, positions, route);
        if (choices.empty()) break;
        Index best = choices.front();
        if (choices.size() > 1) {
            const double reach = graph.radius[at(route.back())] + 10.0;
            double best_distance = std::numeric_limits<double>::infinity();
            for (const Index choice : choices) {
                const double distance = branch_distance(graph, positions, guide, route, choice, reach);
                if (distance < best_distance) {
                    best_distance = distance;
                    best = choice;
                }
            }
        }
        length += apart(positions[at(route.back())], positions[at(best)]);
        route.push_back(best);
    }
}

double insertion_limit(const RouteGraph& graph, std::span<const Vec3> positions, const std::vector<std::int64_t>& route,
                       double look_mm) {
    double length = 0.0;
    for (std::size_t i = 0; i + 1 < route.size(); ++i)
        length += apart(positions[at(route[i])], positions[at(route[i + 1])]);
    // Shortest ways on from the end, route excluded; the search is as wide as look_mm, a few dozen nodes.
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::vector<Index> closed;
    queue.emplace(0.0, static_cast<Index>(route.back()));
    double farthest = 0.0;
    while (!queue.empty() && farthest < look_mm) {
        const auto [d, node] = queue.top();
        queue.pop();
        if (std::find(closed.begin(), closed.end(), node) != closed.end()) continue;
        closed.push_back(node);
        farthest = d;
        for (const Index next : graph.neighbours[at(node)])
            if (!on_route(route, next)) queue.emplace(d + apart(positions[at(node)], positions[at(next)]), next);
    }
    return length + farthest;
}

Rail build_rail(const RouteGraph& graph, std::span<const Vec3> positions, const std::vector<std::int64_t>& route,
                const Pose& mouth, const RailShape& shape) {
    std::vector<Vec3> nodes;
    std::vector<double> radius;
    nodes.reserve(route.size());
    radius.reserve(route.size());
    for (const std::int64_t node : route) {
        nodes.push_back(positions[at(node)]);
        radius.push_back(graph.radius[at(node)]);
    }
    return build_rail(mouth, nodes, radius, shape);
}

}  // namespace cathlab
