// The one file that includes pagmo: its headers are heavy.
#include <algorithm>
#include <cmath>
#include <exception>
#include <pagmo/algorithms/pso_gen.hpp>
#include <pagmo/bfe.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "core/errors.h"
#include "core/parallel.h"
#include "core/random.h"
#include "optimise/swarm.h"

namespace cathlab {
namespace {

constexpr double worst = std::numeric_limits<double>::max();  // pagmo compares; infinity would poison its averages

struct Stop {};  // thrown through pagmo, whose loop has no other way out

/// Evaluates a whole generation at once and keeps the best.
class Evaluator {
public:
    Evaluator(const Problem& problem, const SwarmOptions& options)
        : problem_(problem), options_(options), workers_(options.threads) {}

    pagmo::vector_double generation(const pagmo::vector_double& positions) {
        const std::size_t n = problem_.bounds.size();
        const std::size_t count = positions.size() / n;
        pagmo::vector_double values(count);
        workers_.for_ranges(count, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const double value = problem_.objective({positions.data() + i * n, n});
                values[i] = std::isnan(value) ? worst : std::min(value, worst);
            }
        });
        for (std::size_t i = 0; i < count; ++i) {
            if (values[i] < worst && values[i] < result_.value) {
                result_.value = values[i];
                const auto first = positions.begin() + static_cast<std::ptrdiff_t>(i * n);
                result_.best.assign(first, first + static_cast<std::ptrdiff_t>(n));
            }
        }
        result_.evaluations += static_cast<int>(count);
        result_.best_history.push_back(result_.value);
        return values;
    }

    /// After the generations' values are known: tells the caller, who may stop.
    void report() {
        if (!options_.on_generation) return;
        const SearchProgress progress{result_.generations, options_.generations, result_.evaluations, result_.value,
                                      result_.best};
        if (!options_.on_generation(progress)) {
            result_.stopped = true;
            throw Stop{};
        }
    }

    const Problem& problem() const { return problem_; }
    Result& result() { return result_; }

private:
    const Problem& problem_;
    const SwarmOptions& options_;
    Workers workers_;
    Result result_;
};

struct PagmoProblem {
    Evaluator* evaluator = nullptr;

    pagmo::vector_double fitness(const pagmo::vector_double& x) const {
        const double value = evaluator->problem().objective(x);
        return {std::isnan(value) ? worst : value};
    }
    std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
        std::pair<pagmo::vector_double, pagmo::vector_double> out;
        for (const Bound& bound : evaluator->problem().bounds) {
            out.first.push_back(bound.lower);
            out.second.push_back(bound.upper);
        }
        return out;
    }
};

struct PagmoBatch {
    Evaluator* evaluator = nullptr;

    pagmo::vector_double operator()(const pagmo::problem&, const pagmo::vector_double& positions) const {
        pagmo::vector_double values = evaluator->generation(positions);
        ++evaluator->result().generations;
        evaluator->report();
        return values;
    }
};

void check_options(const SwarmOptions& o) {
    const auto need = [](bool fine, const char* name, double found, const char* allowed) {
        if (!fine)
            throw UserError(std::string("swarm: ") + name + " = " + std::to_string(found) + "; allowed: " + allowed);
    };
    need(o.particles >= 2, "particles", o.particles, "2 or more");
    need(o.generations >= 1, "generations", o.generations, "1 or more");
    need(o.omega >= 0.0 && o.omega <= 1.0, "omega", o.omega, "0 to 1");
    need(o.eta1 >= 0.0 && o.eta1 <= 4.0, "eta1", o.eta1, "0 to 4");
    need(o.eta2 >= 0.0 && o.eta2 <= 4.0, "eta2", o.eta2, "0 to 4");
    need(o.max_speed > 0.0 && o.max_speed <= 1.0, "max_speed", o.max_speed, "above 0 to 1");
}

pagmo::vector_double first_positions(const Problem& problem, const SwarmOptions& options) {
    const std::size_t n = problem.bounds.size();
    pagmo::vector_double out(n * static_cast<std::size_t>(options.particles));
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Bound& bound = problem.bounds[i % n];
        const double u = random_uniform(options.seed, RandomStream::optimiser, i / n, i % n);
        out[i] = std::clamp(bound.lower + u * (bound.upper - bound.lower), bound.lower, bound.upper);
    }
    for (std::size_t j = 0; j < problem.start.size(); ++j)
        out[j] = std::clamp(problem.start[j], problem.bounds[j].lower, problem.bounds[j].upper);
    return out;
}

}  // namespace

Result minimise_swarm(const Problem& problem, const SwarmOptions& options) {
    check_problem(problem);
    check_options(options);
    Evaluator evaluator(problem, options);
    const auto seed = static_cast<unsigned>(random_bits(options.seed, RandomStream::optimiser, 0, 0));
    constexpr unsigned inertia_weight_variant = 1;
    constexpr unsigned whole_swarm = 1;  // every particle knows the best of all
    constexpr unsigned neighbours_unused = 4;
    try {
        const pagmo::vector_double positions = first_positions(problem, options);
        const pagmo::vector_double values = evaluator.generation(positions);
        evaluator.report();
        pagmo::population population(pagmo::problem(PagmoProblem{&evaluator}), 0, seed);
        const std::size_t n = problem.bounds.size();
        for (std::size_t i = 0; i < values.size(); ++i) {
            const auto first = positions.begin() + static_cast<std::ptrdiff_t>(i * n);
            population.push_back(pagmo::vector_double(first, first + static_cast<std::ptrdiff_t>(n)), {values[i]});
        }
        pagmo::pso_gen swarm(static_cast<unsigned>(options.generations), options.omega, options.eta1, options.eta2,
                             options.max_speed, inertia_weight_variant, whole_swarm, neighbours_unused, false, seed);
        swarm.set_bfe(pagmo::bfe(PagmoBatch{&evaluator}));
        swarm.evolve(population);
    } catch (const Stop&) {
        // the best so far is in the evaluator
    }
    return evaluator.result();
}

}  // namespace cathlab
