// One solve of a wire's chain, and of a matrix of its pattern by a well-kept sparse solver: the peer that it has to
// beat.
#include <benchmark/benchmark.h>

#include <Eigen/Sparse>

#include "rod/rod_fixture.h"

namespace cathlab {
namespace {

constexpr double link_mm = 3.0;
constexpr int unknowns = 6;  // of a link

std::vector<ChainRow> rows_on_each(const Rod& rod) {
    std::vector<ChainRow> rows;
    for (std::size_t i = 0; i < rod.free_link_count(); ++i) {
        ChainRow row;
        row.link = static_cast<Index>(i);
        row.normal = Vec3::UnitX();
        row.compliance = 1e-2;
        row.gap = i % 2 == 0 ? -0.01 : 0.02;
        row.friction = 0.1;
        rows.push_back(row);
    }
    return rows;
}

void solve_chain(benchmark::State& state, bool touching) {
    Rod rod(test::amplatz(link_mm), {}, link_mm * static_cast<double>(state.range(0)) - 1.0);
    std::vector<ChainRow> rows;
    if (touching) rows = rows_on_each(rod);
    rod.command(0.0, 0.01);
    rod.predict(0.005);
    for (auto _ : state) rod.solve(0.005, rows);
    state.SetComplexityN(state.range(0));
}

void free_chain(benchmark::State& state) {
    solve_chain(state, false);
}
void touching_chain(benchmark::State& state) {
    solve_chain(state, true);
}

// Factors and solves a symmetric matrix of the chain's pattern, block tridiagonal.
void sparse_peer(benchmark::State& state) {
    const auto n = static_cast<int>(state.range(0)) * unknowns;
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < n; ++i)
        for (int j = std::max(0, (i / unknowns - 1) * unknowns); j < std::min(n, (i / unknowns + 2) * unknowns); ++j)
            entries.emplace_back(i, j, i == j ? 40.0 : 1.0 / (1.0 + std::abs(i - j)));
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(n, -1.0, 1.0);
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
    solver.analyzePattern(matrix);
    for (auto _ : state) {
        solver.factorize(matrix);
        Eigen::VectorXd x = solver.solve(right);
        benchmark::DoNotOptimize(x.data());
    }
    state.SetComplexityN(state.range(0));
}

BENCHMARK(free_chain)->Arg(75)->Arg(150)->Arg(300)->Complexity(benchmark::oN)->Unit(benchmark::kMicrosecond);
BENCHMARK(touching_chain)->Arg(75)->Arg(150)->Arg(300)->Complexity(benchmark::oN)->Unit(benchmark::kMicrosecond);
BENCHMARK(sparse_peer)->Arg(75)->Arg(150)->Arg(300)->Complexity(benchmark::oN)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace cathlab
