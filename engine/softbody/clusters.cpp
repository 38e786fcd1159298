#include "softbody/clusters.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "core/check.h"
#include "core/errors.h"
#include "softbody/geodesic.h"

namespace cathlab {

namespace {

constexpr double dart_radius = 0.83;  // of the local spacing; leaves spacing^2 to each centre, as for particles
constexpr std::uint64_t centre_seed = 0x636C7573746572;
constexpr std::size_t sorting_block = 16;  // clusters that are near in memory and sorted by size among themselves

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

/// Links and their diagonals (a neighbour's neighbours): paths along links alone zigzag and come out 7 % too long.
Graph with_diagonals(const WallSample& sample) {
    const Graph near = make_graph(sample.links, sample.position);
    std::vector<std::pair<Index, Index>> edges = sample.links;
    for (std::size_t v = 0; v < near.size(); ++v)
        for (Index e = near.start[v]; e < near.start[v + 1]; ++e) {
            const std::size_t mid = at(near.neighbour[at(e)]);
            for (Index f = near.start[mid]; f < near.start[mid + 1]; ++f)
                if (near.neighbour[at(f)] > static_cast<Index>(v))
                    edges.emplace_back(static_cast<Index>(v), near.neighbour[at(f)]);
        }
    return make_graph(edges, sample.position);
}

/// Distance between particles as the areas tell it, smoothed along the wall.
std::vector<double> local_spacing(const WallSample& sample, const Graph& graph) {
    std::vector<double> area = sample.area_mm2;
    for (int round = 0; round < 3; ++round) {
        std::vector<double> next(area.size());
        for (std::size_t v = 0; v < area.size(); ++v) {
            double sum = area[v];
            for (Index e = graph.start[v]; e < graph.start[v + 1]; ++e) sum += area[at(graph.neighbour[at(e)])];
            next[v] = sum / (1 + graph.start[v + 1] - graph.start[v]);
        }
        area = std::move(next);
    }
    for (double& a : area) a = std::sqrt(a);
    return area;
}

struct Sizes {
    std::vector<double> spacing, radius;  // one a particle
};

Sizes local_sizes(const WallSample& sample, const WallParameters& parameters, const Graph& graph) {
    const std::vector<double> distance = local_spacing(sample, graph);
    Sizes sizes;
    for (std::size_t v = 0; v < distance.size(); ++v) {
        const double scale = std::min(1.0, distance[v] / parameters.reference_spacing_mm);
        double spacing = scale * parameters.cluster_spacing_mm, radius = scale * parameters.cluster_radius_mm;
        for (const RegionWall& own : parameters.regions) {
            if (own.region != sample.region[v]) continue;
            if (own.cluster_spacing_mm) spacing = *own.cluster_spacing_mm;
            if (own.cluster_radius_mm) radius = *own.cluster_radius_mm;
        }
        sizes.spacing.push_back(spacing);
        sizes.radius.push_back(radius);
    }
    return sizes;
}

[[noreturn]] void refuse(const WallParameters& parameters, std::size_t alone, double needed) {
    char text[320];
    // `needed` is the largest distance to a centre, in cluster radii.
    std::snprintf(text, sizeof text,
                  "cluster_radius_mm = %g with cluster_spacing_mm = %g leaves %zu wall particles without a cluster; a "
                  "radius of at least %.3g mm would do at this spacing, or a spacing of at most %.3g mm at this radius",
                  parameters.cluster_radius_mm, parameters.cluster_spacing_mm, alone,
                  1.02 * needed * parameters.cluster_radius_mm, 0.95 * parameters.cluster_spacing_mm / needed);
    throw UserError(text);
}

template <class Real>
ClusterGroups<Real> pack(const Membership& lanes, const SoftBodyModel& model) {
    ClusterGroups<Real> packed;
    constexpr std::size_t n = kernel::lanes;
    const std::size_t groups = (lanes.size() + n - 1) / n;
    packed.first_slot.assign(groups + 1, 0);
    for (std::size_t g = 0; g < groups; ++g) {
        std::size_t slots = 0;
        for (std::size_t l = 0; l < n && g * n + l < lanes.size(); ++l)
            slots = std::max(slots, lanes[g * n + l].size());
        packed.first_slot[g + 1] = packed.first_slot[g] + static_cast<std::int32_t>(slots);
    }
    const auto slots = static_cast<std::size_t>(packed.first_slot.back());
    packed.place.assign(slots * n, 0);
    packed.member.assign(slots * 4 * n, Real(0));
    packed.rest_centroid.assign(groups * 3 * n, 0.0);
    packed.rotation_unit = model.goals.rotation_unit;
    const auto weight = [&](Index i) {
        return model.mass[at(i)] / (model.cluster_start[at(i) + 1] - model.cluster_start[at(i)]);
    };
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
        const std::size_t g = lane / n, l = lane % n, first = at(packed.first_slot[g]);
        const std::size_t count = at(packed.first_slot[g + 1]) - first;
        Vec3 sum = Vec3::Zero();
        double total = 0.0;
        const Vec3 origin = model.rest[at(lanes[lane].front())];
        for (const Index i : lanes[lane]) {
            sum += weight(i) * (model.rest[at(i)] - origin);
            total += weight(i);
        }
        const Vec3 centroid = origin + sum / total;
        for (std::size_t axis = 0; axis < 3; ++axis)
            packed.rest_centroid[(g * 3 + axis) * n + l] = centroid[static_cast<Index>(axis)];
        for (std::size_t s = 0; s < count; ++s) {
            const std::size_t slot = first + s;
            if (s >= lanes[lane].size()) {
                packed.place[slot * n + l] = 3 * lanes[lane].front();
                continue;
            }
            const Index i = lanes[lane][s];
            const double w = weight(i) / total;
            const Vec3 moment = w * (model.rest[at(i)] - centroid);
            packed.place[slot * n + l] = 3 * i;
            for (std::size_t axis = 0; axis < 3; ++axis)
                packed.member[(slot * 4 + axis) * n + l] = static_cast<Real>(moment[static_cast<Index>(axis)]);
            packed.member[(slot * 4 + 3) * n + l] = static_cast<Real>(w);
        }
    }
    return packed;
}

GoalSources goal_sources(const SoftBodyModel& model) {
    constexpr std::size_t four = 4;
    const std::size_t bytes =
        kernel::transform_numbers * (model.precision == Precision::double_ ? sizeof(double) : sizeof(std::int32_t));
    GoalSources goals;
    Index most = 1;
    for (std::size_t i = 0; i < model.size(); ++i)
        most = std::max(most, model.cluster_start[i + 1] - model.cluster_start[i]);
    goals.rotation_unit = kernel::rotation_room;
    for (Index room = 1; room < most; room *= 2) goals.rotation_unit /= 2.0;
    goals.first.reserve(model.size() + 1);
    goals.share.reserve(model.size());
    goals.from.reserve(model.membership_count() + (four - 1) * model.size());
    goals.first.push_back(0);
    for (std::size_t i = 0; i < model.size(); ++i) {
        for (Index m = model.cluster_start[i]; m < model.cluster_start[i + 1]; ++m)
            goals.from.push_back(static_cast<std::int32_t>(at(model.cluster[at(m)]) * bytes));
        CATHLAB_CHECK(model.cluster_start[i + 1] > model.cluster_start[i], "a particle without a cluster has no goal");
        while (goals.from.size() % four != 0)
            goals.from.push_back(static_cast<std::int32_t>(model.empty_lane() * bytes));
        goals.first.push_back(static_cast<std::int32_t>(goals.from.size()));
        goals.share.push_back(1.0 / (model.cluster_start[i + 1] - model.cluster_start[i]));
    }
    goals.from.shrink_to_fit();
    return goals;
}

}  // namespace

Membership grow_clusters(const WallSample& sample, const WallParameters& parameters) {
    const Graph graph = with_diagonals(sample);
    const Sizes sizes = local_sizes(sample, parameters, graph);
    const Graph by_spacing = in_units(graph, sizes.spacing), by_radius = in_units(graph, sizes.radius);
    std::vector<Index> centres = scatter(by_spacing, dart_radius, centre_seed);
    std::vector<double> weight(sample.position.size());
    for (std::size_t v = 0; v < weight.size(); ++v) weight[v] = sample.area_mm2[v] / std::pow(sizes.spacing[v], 2);
    relax(by_spacing, sample.position, weight, 1, centres);

    Membership membership;
    std::vector<std::uint8_t> held(sample.position.size(), 0);
    Reach reach(by_radius);
    for (const Index centre : centres) {
        std::vector<Index>& members = membership.emplace_back();
        for (const Reach::Hit& hit : reach.within(centre, 1.0)) {
            members.push_back(hit.node);
            held[at(hit.node)] = 1;
        }
        std::sort(members.begin(), members.end());
    }
    const auto alone = static_cast<std::size_t>(std::count(held.begin(), held.end(), 0));
    if (alone > 0) {
        const Cells cells = nearest_source(by_radius, centres);
        refuse(parameters, alone, *std::max_element(cells.distance.begin(), cells.distance.end()));
    }
    return membership;
}

void pack_clusters(const Membership& membership, SoftBodyModel& model) {
    // Lanes of like size waste little padding; sorting only within blocks keeps a group's particles near in memory.
    std::vector<std::size_t> order(membership.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t first = 0; first < order.size(); first += sorting_block) {
        const auto begin = order.begin() + static_cast<std::ptrdiff_t>(first);
        const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(first + sorting_block, order.size()));
        std::stable_sort(begin, end,
                         [&](std::size_t a, std::size_t b) { return membership[a].size() > membership[b].size(); });
    }
    Membership lanes;
    lanes.reserve(order.size());
    for (const std::size_t c : order) lanes.push_back(membership[c]);

    model.cluster_count = lanes.size();
    model.cluster_start.assign(model.size() + 1, 0);
    for (const auto& members : lanes)
        for (const Index i : members) ++model.cluster_start[at(i) + 1];
    std::partial_sum(model.cluster_start.begin(), model.cluster_start.end(), model.cluster_start.begin());
    model.cluster.assign(at(model.cluster_start.back()), 0);
    std::vector<Index> next(model.cluster_start.begin(), model.cluster_start.end() - 1);
    for (std::size_t lane = 0; lane < lanes.size(); ++lane)
        for (const Index i : lanes[lane]) model.cluster[at(next[at(i)]++)] = static_cast<Index>(lane);

    model.goals = goal_sources(model);
    if (model.precision == Precision::double_)
        model.clusters = pack<double>(lanes, model);
    else
        model.clusters_float = pack<float>(lanes, model);
}

}  // namespace cathlab
