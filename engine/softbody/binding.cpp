#include "softbody/binding.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/check.h"
#include "core/errors.h"
#include "softbody/geodesic.h"
#include "softbody/near_grid.h"

namespace cathlab {

namespace {

constexpr double exact_mm = 1e-10;     // how well a point must be reproduced
constexpr double modest_weight = 1.0;  // above this, more particles share the point
constexpr std::size_t most_particles = 64;
constexpr double facing = 0.0;  // cosine between normals from which two places belong to one side of a wall

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}
using Candidates = std::vector<std::pair<double, Index>>;  // squared distance, particle

struct Weights {
    std::vector<double> weight;
    double error_mm = 0.0, largest = 0.0;
};

/// Weights of the `count` nearest candidates: w_j = phi_j (1 / sum phi + (d_j - d_mean) . C^+ (-d_mean)), d_j = X_j -
/// Q, the minimiser of sum w_j^2 / phi_j under sum w = 1 and sum w d = 0.
Weights solve(const SoftBodyModel& model, const Vec3& point, const Candidates& candidates, std::size_t count) {
    const double last = candidates[count - 1].first;
    const double reach2 = count < candidates.size() ? std::max(candidates[count].first, 1.02 * last) : 1.3 * last;
    std::vector<double> phi(count);
    double total = 0.0;
    Vec3 mean = Vec3::Zero();
    for (std::size_t j = 0; j < count; ++j) {
        const double fall = 1.0 - candidates[j].first / std::max(reach2, 1e-300);
        phi[j] = std::max(fall * fall, 1e-6);
        total += phi[j];
        mean += phi[j] * (model.rest[at(candidates[j].second)] - point);
    }
    mean /= total;
    Mat3 spread = Mat3::Zero();
    for (std::size_t j = 0; j < count; ++j) {
        const Vec3 d = model.rest[at(candidates[j].second)] - point - mean;
        spread += phi[j] * d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Mat3> axes(spread);
    Weights result;
    result.weight.resize(count);
    for (std::size_t j = 0; j < count; ++j) result.weight[j] = phi[j] / total;
    Vec3 error = mean;  // sum w d so far
    for (int round = 0; round < 3; ++round) {
        Vec3 tilt = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
            if (axes.eigenvalues()[k] > 1e-12 * axes.eigenvalues()[2])
                tilt -= axes.eigenvectors().col(k) * (axes.eigenvectors().col(k).dot(error) / axes.eigenvalues()[k]);
        error.setZero();
        double sum = 0.0;
        for (std::size_t j = 0; j < count; ++j) {
            const Vec3 d = model.rest[at(candidates[j].second)] - point;
            result.weight[j] += phi[j] * (d - mean).dot(tilt);
            sum += result.weight[j];
        }
        for (std::size_t j = 0; j < count; ++j) {
            result.weight[j] += (1.0 - sum) / static_cast<double>(count);
            error += result.weight[j] * (model.rest[at(candidates[j].second)] - point);
        }
    }
    result.error_mm = error.norm();
    for (const double w : result.weight) result.largest = std::max(result.largest, std::fabs(w));
    return result;
}

/// Gathers the candidates of a point, nearest first.
class Gatherer {
public:
    explicit Gatherer(const SoftBodyModel& model)
        : model_(model), graph_(make_graph(model.links, model.rest)), reach_(graph_), grid_(model.rest, cell(model)) {}

    void gather(const Vec3& point, const Vec3* normal, bool along_wall, std::size_t count, Candidates& out) {
        if (!along_wall) {
            out = grid_.nearest(point, count);
            return;
        }
        out.clear();
        // Along the links the hits come by distance from the nearest particle; twice as many hold the nearest to the
        // point.
        for (const Reach::Hit& hit : reach_.within(nearest(point, normal), 1e300, 2 * count + 8))
            out.emplace_back((model_.rest[at(hit.node)] - point).squaredNorm(), hit.node);
        std::sort(out.begin(), out.end());
    }

private:
    static double cell(const SoftBodyModel& model) {
        double sum = 0.0;
        for (const auto& [a, b] : model.links) sum += (model.rest[at(a)] - model.rest[at(b)]).norm();
        return model.links.empty() ? 1.0 : std::max(1e-3, sum / static_cast<double>(model.links.size()));
    }

    Index nearest(const Vec3& point, const Vec3* normal) {
        const Candidates& near = grid_.nearest(point, 1);
        if (normal && normal->squaredNorm() > 0.0) {
            // A wall that faces the other way counts only where no other lies within three times its distance.
            const Index first = near.front().second;
            if (model_.normal[at(first)].dot(*normal) > facing) return first;
            const double limit = 3.0 * std::sqrt(near.front().first) + 1e-6;
            for (const auto& [d2, i] : grid_.within(point, limit))
                if (model_.normal[at(i)].dot(*normal) > facing) return i;
            return first;
        }
        return near.front().second;
    }

    const SoftBodyModel& model_;
    Graph graph_;
    Reach reach_;
    NearGrid grid_;
};

}  // namespace

double PointBinding::largest_weight() const {
    double largest = 0.0;
    for (const double w : weight) largest = std::max(largest, std::fabs(w));
    return largest;
}

PointBinding bind_points(const SoftBodyModel& model, std::span<const Vec3> points, int particles_per_point,
                         bool along_wall, std::span<const Vec3> normals) {
    CATHLAB_CHECK(particles_per_point >= 4, "a point in space needs four particles");
    CATHLAB_CHECK(normals.empty() || normals.size() == points.size(), "one normal a point");
    PointBinding binding;
    binding.start.push_back(0);
    if (points.empty()) return binding;
    Gatherer gatherer(model);
    Candidates candidates;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3* normal = normals.empty() ? nullptr : &normals[i];
        Weights best;
        std::size_t best_count = 0;
        for (std::size_t count = static_cast<std::size_t>(particles_per_point); count <= most_particles;
             count += std::max<std::size_t>(2, count / 4)) {
            gatherer.gather(points[i], normal, along_wall, count + 1, candidates);
            const std::size_t used = std::min(count, candidates.size());
            Weights tried = solve(model, points[i], candidates, used);
            const bool tried_exact = tried.error_mm <= exact_mm,
                       best_exact = best_count > 0 && best.error_mm <= exact_mm;
            if (best_count == 0 || (tried_exact && (!best_exact || tried.largest < best.largest)) ||
                (!tried_exact && !best_exact && tried.error_mm < best.error_mm)) {
                best = std::move(tried);
                best_count = used;
            }
            if ((best.error_mm <= exact_mm && best.largest <= modest_weight) || used < count) break;
        }
        if (!(best.error_mm <= exact_mm)) {
            char text[240];
            std::snprintf(
                text, sizeof text,
                "the point (%.6g, %.6g, %.6g) cannot ride on the wall: the particles near it miss it by %.3g mm "
                "(they lie in one plane, or there are fewer than four); a finer particle spacing would do",
                points[i].x(), points[i].y(), points[i].z(), best.error_mm);
            throw UserError(text);
        }
        // The candidates of the best count are the nearest of any later gathering only in space; gather them once more.
        gatherer.gather(points[i], normal, along_wall, best_count + 1, candidates);
        for (std::size_t j = 0; j < best_count; ++j) {
            binding.particle.push_back(candidates[j].second);
            binding.weight.push_back(best.weight[j]);
        }
        binding.start.push_back(static_cast<Index>(binding.particle.size()));
    }
    return binding;
}

void evaluate_all(const PointBinding& binding, std::span<const Vec3> x, std::span<Vec3> out, const Workers& workers) {
    CATHLAB_CHECK(out.size() == binding.size(), "one place a point");
    workers.for_ranges(binding.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) out[i] = evaluate(binding, i, x);
    });
}

void add_force(const PointBinding& binding, std::size_t i, const Vec3& force, std::span<Vec3> particle_force) {
    for (Index k = binding.start[i]; k < binding.start[i + 1]; ++k)
        particle_force[at(binding.particle[at(k)])] += binding.weight[at(k)] * force;
}

double point_compliance(const PointBinding& binding, std::size_t i, std::span<const double> particle_compliance) {
    double sum = 0.0;
    for (Index k = binding.start[i]; k < binding.start[i + 1]; ++k)
        sum += binding.weight[at(k)] * binding.weight[at(k)] * particle_compliance[at(binding.particle[at(k)])];
    return sum;
}

}  // namespace cathlab
