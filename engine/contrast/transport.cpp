#include "contrast/transport.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace cathlab {
namespace {

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

// Flow of each edge, positive in the edge's own direction, and what runs back into the heart at the root.
struct Flows {
    std::vector<double> edge;
    double into_heart = 0.0;
};

Flows flows_during(const ContrastModel& model, const Injection& injection, double scale) {
    Flows flows;
    flows.edge.reserve(model.edges.size());
    for (const ContrastModel::Edge& edge : model.edges) flows.edge.push_back(scale * edge.flow_ml_s);
    if (injection.flow_ml_s <= 0.0) return flows;
    Index node = injection.node;
    while (model.upstream_edge[at(node)] >= 0) {
        const Index e = model.upstream_edge[at(node)];
        flows.edge[at(e)] -= injection.flow_ml_s;
        node = model.edges[at(e)].from;
    }
    flows.into_heart = std::max(0.0, injection.flow_ml_s - scale * model.spec.cardiac_output_ml_s);
    return flows;
}

// Edges into each node, as a compressed list, and the nodes from upstream to downstream.  False where the flow runs in
// a ring.
struct Network {
    std::vector<std::size_t> first, edge;  // edges into node i: edge[first[i]] .. edge[first[i + 1] - 1]
    std::vector<std::size_t> order;
};

bool arrange(const ContrastModel& model, const std::vector<double>& flow, Network& net) {
    const std::size_t n = model.volume_ml.size();
    const auto sink = [&](std::size_t e) { return at(flow[e] > 0.0 ? model.edges[e].to : model.edges[e].from); };
    const auto spring = [&](std::size_t e) { return at(flow[e] > 0.0 ? model.edges[e].from : model.edges[e].to); };
    net.first.assign(n + 1, 0);
    std::vector<std::size_t> out_first(n + 1, 0), waiting(n, 0);
    for (std::size_t e = 0; e < flow.size(); ++e) {
        if (flow[e] == 0.0) continue;
        ++net.first[sink(e) + 1];
        ++out_first[spring(e) + 1];
        ++waiting[sink(e)];
    }
    for (std::size_t i = 0; i < n; ++i) {
        net.first[i + 1] += net.first[i];
        out_first[i + 1] += out_first[i];
    }
    net.edge.assign(net.first[n], 0);
    std::vector<std::size_t> out(out_first[n], 0), in_at(net.first.begin(), net.first.end() - 1),
        out_at(out_first.begin(), out_first.end() - 1);
    for (std::size_t e = 0; e < flow.size(); ++e) {
        if (flow[e] == 0.0) continue;
        net.edge[in_at[sink(e)]++] = e;
        out[out_at[spring(e)]++] = sink(e);
    }
    net.order.clear();
    for (std::size_t i = 0; i < n; ++i)
        if (waiting[i] == 0) net.order.push_back(i);
    for (std::size_t k = 0; k < net.order.size(); ++k)
        for (std::size_t j = out_first[net.order[k]]; j < out_first[net.order[k] + 1]; ++j)
            if (--waiting[out[j]] == 0) net.order.push_back(out[j]);
    return net.order.size() == n;
}

}  // namespace

void visit(Archive& archive, ContrastState& state) {
    archive.field("concentration", state.concentration);
    archive.field("injected_ml", state.injected_ml);
    archive.field("injected_mg", state.injected_mg);
    archive.field("washed_out_mg", state.washed_out_mg);
}

ContrastState initial_state(const ContrastModel& model) {
    ContrastState state;
    state.concentration.assign(model.volume_ml.size(), 0.0);
    return state;
}

void advance(const ContrastModel& model, ContrastState& state, const Injection& wanted, double dt, double flow_scale) {
    CATHLAB_CHECK(flow_scale >= 0.0 && dt >= 0.0, "flow and time run forward");
    Injection injection = wanted;
    if (!(injection.flow_ml_s > 0.0) || !std::isfinite(injection.flow_ml_s)) injection.flow_ml_s = 0.0;
    if (injection.flow_ml_s == 0.0 && state.injected_mg == 0.0) return;  // nothing to carry yet
    CATHLAB_CHECK(at(injection.node) < model.volume_ml.size(), "the injection is at a node of the graph");

    Flows flows = flows_during(model, injection, flow_scale);
    Network net;
    if (!arrange(model, flows.edge, net)) {
        // Reflux round a loop would feed itself: there the medium goes downstream only.
        for (double& flow : flows.edge) flow = std::max(flow, 0.0);
        arrange(model, flows.edge, net);
    }
    const std::size_t n = model.volume_ml.size();
    std::vector<double> leaving(n, 0.0);
    for (std::size_t e = 0; e < flows.edge.size(); ++e)
        leaving[at(flows.edge[e] > 0.0 ? model.edges[e].from : model.edges[e].to)] += std::fabs(flows.edge[e]);

    const double injected_mg = dt * injection.flow_ml_s * model.spec.concentration_mgi_ml;
    for (const std::size_t i : net.order) {
        double mass = model.volume_ml[i] * state.concentration[i];
        for (std::size_t k = net.first[i]; k < net.first[i + 1]; ++k) {
            const std::size_t e = net.edge[k];
            const Index from = flows.edge[e] > 0.0 ? model.edges[e].from : model.edges[e].to;
            mass += dt * std::fabs(flows.edge[e]) * state.concentration[at(from)];
        }
        if (i == at(injection.node)) mass += injected_mg;
        double away = flow_scale * model.outflow_ml_s[i];
        if (i == at(model.root)) away += flows.into_heart;
        const double room = model.volume_ml[i] + dt * (leaving[i] + away);
        if (room <= 0.0) continue;
        state.concentration[i] = mass / room;
        state.washed_out_mg += dt * away * state.concentration[i];
    }
    state.injected_ml += dt * injection.flow_ml_s;
    state.injected_mg += injected_mg;
}

double iodine_in_tree_mg(const ContrastModel& model, const ContrastState& state) {
    double sum = 0.0;
    for (std::size_t i = 0; i < model.volume_ml.size(); ++i) sum += model.volume_ml[i] * state.concentration[i];
    return sum;
}

}  // namespace cathlab
