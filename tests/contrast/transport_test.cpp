#include "contrast/transport.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"

using namespace cathlab;

namespace {

Index run(CentrelineGraph& graph, Index from, const Vec3& step, int count, double radius, Index region) {
    for (int i = 0; i < count; ++i) {
        const Vec3 p =
            from < 0 ? Vec3(Vec3::Zero()) : Vec3(graph.nodes[static_cast<std::size_t>(from)].position + step);
        graph.nodes.push_back({p, radius, region});
        const auto index = static_cast<Index>(graph.nodes.size() - 1);
        if (from >= 0) graph.edges.emplace_back(index, from);
        from = index;
    }
    return from;
}

// An aorta (region 0) with a coronary (1) near its root and two legs (2, 3).
struct Body {
    CentrelineGraph graph;
    Index coronary_end = 0, left = 0, right = 0, ostium = 0;
};
Body body() {
    Body b;
    b.ostium = run(b.graph, -1, Vec3(0, 0, 2), 10, 12.0, 0);
    b.coronary_end = run(b.graph, b.ostium, Vec3(2, 0, 0), 40, 1.6, 1);
    const Index fork = run(b.graph, b.ostium, Vec3(0, 0, 2), 150, 10.0, 0);
    b.left = run(b.graph, fork, Vec3(1, 0, 2), 80, 4.0, 2);
    b.right = run(b.graph, fork, Vec3(-1, 0, 2), 80, 5.0, 3);
    return b;
}

void expect_balance(const ContrastModel& model, const ContrastState& state) {
    const double kept = iodine_in_tree_mg(model, state) + state.washed_out_mg;
    EXPECT_NEAR(kept, state.injected_mg, 1e-12 * std::max(1.0, state.injected_mg));
}

}  // namespace

TEST(ContrastFlow, EveryNodeLetsOutWhatComesIn) {
    const Body b = body();
    ContrastSpec spec;
    spec.region_share = {-1.0, 0.045, -1.0, -1.0};
    const ContrastModel model = build_contrast(b.graph, 0, spec);
    std::vector<double> balance(b.graph.nodes.size(), 0.0);
    balance[0] = spec.cardiac_output_ml_s;
    for (const auto& edge : model.edges) {
        balance[static_cast<std::size_t>(edge.from)] -= edge.flow_ml_s;
        balance[static_cast<std::size_t>(edge.to)] += edge.flow_ml_s;
    }
    for (std::size_t i = 0; i < balance.size(); ++i) EXPECT_NEAR(balance[i], model.outflow_ml_s[i], 1e-11);
    EXPECT_NEAR(model.outflow_ml_s[static_cast<std::size_t>(b.coronary_end)], 0.045 * 83.0, 1e-12);
    EXPECT_NEAR(
        model.outflow_ml_s[static_cast<std::size_t>(b.right)] / model.outflow_ml_s[static_cast<std::size_t>(b.left)],
        125.0 / 64.0, 1e-12);
}

TEST(Contrast, IodineIsNeitherMadeNorLostForAnyStep) {
    const Body b = body();
    const ContrastModel model = build_contrast(b.graph, 0, {});
    for (const double dt : {0.001, 0.02, 1.0, 100.0}) {
        ContrastState state = initial_state(model);
        for (int i = 0; i < 400; ++i) {
            const bool on = i < 100;
            advance(model, state, {i % 3 == 0 ? b.coronary_end : b.ostium, on ? 12.0 : 0.0}, dt,
                    0.5 + 0.5 * std::sin(0.3 * i));
            for (const double c : state.concentration) {
                EXPECT_TRUE(std::isfinite(c));
                EXPECT_GE(c, 0.0);
                EXPECT_LE(c, 350.0 * (1.0 + 1e-12));
            }
        }
        expect_balance(model, state);
    }
}

TEST(Contrast, ASteadyInjectionIsDilutedByTheFlow) {
    const Body b = body();
    const ContrastModel model = build_contrast(b.graph, 0, {});
    ContrastState state = initial_state(model);
    for (int i = 0; i < 5000; ++i) advance(model, state, {b.ostium, 15.0}, 0.02);
    EXPECT_NEAR(state.concentration[static_cast<std::size_t>(b.left)], 350.0 * 15.0 / 83.0, 1e-6);
    EXPECT_EQ(state.concentration[0], 0.0);  // nothing upstream
    EXPECT_NEAR(state.injected_ml, 15.0 * 100.0, 1e-9);
}

TEST(Contrast, TheBolusArrivesWhenTheFlowHasFilledTheWayAndWashesOut) {
    const Body b = body();
    const ContrastModel model = build_contrast(b.graph, 0, {});
    ContrastState state = initial_state(model);
    double moment = 0.0, sum = 0.0;
    const auto fork = static_cast<std::size_t>(b.ostium) + 40 + 150;
    for (int i = 0; i < 3000; ++i) {
        advance(model, state, {b.ostium, i < 5 ? 15.0 : 0.0}, 0.02);
        moment += state.concentration[fork] * i * 0.02;
        sum += state.concentration[fork];
    }
    // Mean transit time = volume / flow (Stewart and Hamilton), from the middle of the injection.
    double volume = 0.5 * model.volume_ml[fork];
    for (std::size_t i = static_cast<std::size_t>(b.ostium) + 41; i < fork; ++i) volume += model.volume_ml[i];
    volume += 0.5 * model.volume_ml[static_cast<std::size_t>(b.ostium)];
    const double transit = volume / 83.0;
    EXPECT_NEAR(moment / sum - 0.04, transit, 0.05 * transit);
    EXPECT_LT(iodine_in_tree_mg(model, state), 1e-3 * state.injected_mg);
    expect_balance(model, state);
}

TEST(Contrast, MoreThanTheVesselCarriesRefluxesToTheAorta) {
    const Body b = body();
    ContrastSpec spec;
    spec.region_share = {-1.0, 0.03, -1.0, -1.0};  // 2.5 mL/s
    const ContrastModel model = build_contrast(b.graph, 0, spec);
    ContrastState gentle = initial_state(model), strong = gentle;
    const Index tip = b.ostium + 10;  // 20 mm into the coronary
    for (int i = 0; i < 2000; ++i) {
        advance(model, gentle, {tip, 1.5}, 0.02);
        advance(model, strong, {tip, 4.0}, 0.02);
    }
    const auto leg = static_cast<std::size_t>(b.left), end = static_cast<std::size_t>(b.coronary_end);
    EXPECT_EQ(gentle.concentration[leg], 0.0);
    EXPECT_NEAR(gentle.concentration[end], 350.0 * 1.5 / 2.49, 1e-6);
    EXPECT_NEAR(strong.concentration[end], 350.0, 1e-6);
    EXPECT_NEAR(strong.concentration[leg], 350.0 * (4.0 - 2.49) / (83.0 - 2.49), 1e-6);
}

TEST(Contrast, ALoopInTheGraphCarriesBothWaysRound) {
    CentrelineGraph graph;
    const Index in = run(graph, -1, Vec3(0, 0, 2), 20, 5.0, 0);
    const Index a = run(graph, in, Vec3(1, 0, 2), 10, 3.0, 0), c = run(graph, in, Vec3(-2, 0, 2), 10, 3.0, 0);
    const Index out = run(graph, a, Vec3(-1, 0, 2), 1, 5.0, 0);
    graph.edges.emplace_back(c, out);
    const Index end = run(graph, out, Vec3(0, 0, 2), 20, 5.0, 0);
    const ContrastModel model = build_contrast(graph, 0, {});
    ContrastState state = initial_state(model);
    for (int i = 0; i < 2000; ++i)
        advance(model, state, {i < 1000 ? out + 3 : 3, 100.0}, 0.02);  // reflux round the loop, too
    expect_balance(model, state);
    EXPECT_NEAR(state.concentration[static_cast<std::size_t>(end)], 350.0, 1.0);
}

TEST(Contrast, NonsenseIsRefused) {
    ContrastSpec spec;
    EXPECT_NO_THROW(validate(spec));
    spec.region_share = {0.7, 0.6};
    EXPECT_THROW(validate(spec), UserError);
    spec = {};
    spec.cardiac_output_ml_s = -1.0;
    EXPECT_THROW(validate(spec), UserError);
    CentrelineGraph graph;
    graph.nodes.push_back({Vec3::Zero(), 1.0, 0});
    EXPECT_THROW(build_contrast(graph, 0, {}), UserError);
    const Body b = body();
    const ContrastModel model = build_contrast(b.graph, 0, {});
    ContrastState state = initial_state(model);
    advance(model, state, {3, std::nan("")}, 0.02);
    EXPECT_EQ(state.injected_mg, 0.0);
}
