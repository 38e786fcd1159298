// One pass over the wall's clusters, and one of Bullet's over the same.
#include <benchmark/benchmark.h>

#include "peer/bullet_clusters.h"
#include "softbody/solver.h"
#include "softbody/tube.h"

namespace cathlab {
namespace {

constexpr double spacing_mm = 2.0;
constexpr double step_s = 0.004;

SoftBodyModel wall(const benchmark::State& state, Precision precision) {
    WallParameters parameters;
    parameters.reference_spacing_mm = 0.5 * spacing_mm;  // s_c and r_c as they stand
    parameters.precision = precision;
    const auto particles = static_cast<std::size_t>(state.range(0));
    return build_soft_body(tube_sample(tube_for(particles, spacing_mm), spacing_mm, 1.5, 7), parameters, nullptr);
}

void wall_pass(benchmark::State& state, Precision precision) {
    const SoftBodyModel model = wall(state, precision);
    SoftBodyState moving = rest_state(model);
    SoftBodyScratch scratch;
    const Workers alone(1);
    predict(model, moving, scratch, step_s, {}, alone);
    for (auto _ : state) solve_and_apply(model, moving, scratch, step_s, 1, alone);
    state.SetComplexityN(static_cast<std::int64_t>(model.membership_count()));
}

void float_pass(benchmark::State& state) {
    wall_pass(state, Precision::float_);
}
void double_pass(benchmark::State& state) {
    wall_pass(state, Precision::double_);
}
void bullet_pass(benchmark::State& state) {
    const SoftBodyModel model = wall(state, Precision::float_);
    BulletClusters bullet(model, 0.8, ClusterTree::none);
    for (auto _ : state) bullet.pass();
    state.SetComplexityN(static_cast<std::int64_t>(model.membership_count()));
}

BENCHMARK(float_pass)->Arg(1000)->Arg(10000)->Arg(40000)->Complexity(benchmark::oN)->Unit(benchmark::kMicrosecond);
BENCHMARK(double_pass)->Arg(1000)->Arg(10000)->Arg(40000)->Complexity(benchmark::oN)->Unit(benchmark::kMicrosecond);
BENCHMARK(bullet_pass)->Arg(1000)->Arg(10000)->Arg(40000)->Complexity(benchmark::oN)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace cathlab
