#include "softbody/elastic.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/deterministic_math.h"

namespace cathlab {
namespace {

constexpr std::size_t n = kernel::lanes;
constexpr double largest_eigenvalue = 1.25;  // of stiffness over k
constexpr int power_rounds = 60;
constexpr double safety = 1.05;            // the power method comes from below
constexpr std::size_t sorting_block = 32;  // groups within which triangles of like patches stand together

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

void set_constants(const ShellTriangle& t, double* to) {
    const double numbers[kernel::elastic_constants] = {t.rest_inverse(0, 0),
                                                       t.rest_inverse(0, 1),
                                                       t.rest_inverse(1, 1),
                                                       t.area_mm2 * t.thickness_mm * t.mu_kpa,
                                                       t.thinning,
                                                       t.area_mm2 * t.thickness_mm,
                                                       t.area_mm2 * t.bending_mn_mm,
                                                       t.poisson,
                                                       t.rest_curvature[0],
                                                       t.rest_curvature[1],
                                                       t.rest_curvature[2],
                                                       t.round.x(),
                                                       t.round.y()};
    for (std::size_t k = 0; k < kernel::elastic_constants; ++k) to[k * n] = numbers[k];
}

}  // namespace

kernel::Elastic ElasticGroups::view(const Fibres& fibres, const double* scale, const double* law) const {
    return {first_slot.data(),
            place.data(),
            second.data(),
            constant.data(),
            scale,
            law,
            fibres.stiffness_kpa,
            fibres.exponent,
            fibres.onset,
            std::sqrt(fibre_exponent_limit / fibres.exponent),
            fibres.cosine(),
            fibres.sine()};
}

ElasticGroups pack_shell(const ShellModel& shell) {
    std::vector<std::size_t> order(shell.triangles.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    for (std::size_t first = 0; first < order.size(); first += sorting_block * n)
        std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(first),
                         order.begin() + static_cast<std::ptrdiff_t>(std::min(first + sorting_block * n, order.size())),
                         [&](std::size_t a, std::size_t b) {
                             return shell.triangles[a].patch.size() > shell.triangles[b].patch.size();
                         });
    ElasticGroups out;
    const std::size_t groups = (order.size() + n - 1) / n;
    std::vector<std::vector<std::int32_t>> of_particle(shell.particles);
    out.constant.assign(groups * kernel::elastic_constants * n, 0.0);
    out.first_slot.push_back(0);
    for (std::size_t g = 0; g < groups; ++g) {
        std::size_t longest = 0;
        for (std::size_t l = 0; l < n && g * n + l < order.size(); ++l)
            longest = std::max(longest, shell.triangles[order[g * n + l]].patch.size());
        const std::size_t first = at(out.first_slot.back());
        out.first_slot.push_back(static_cast<std::int32_t>(first + longest));
        out.place.resize((first + longest) * n);
        out.second.resize((first + longest) * 3 * n, 0.0);
        for (std::size_t l = 0; l < n; ++l) {
            // An empty lane is a triangle without stiffness where the last one is.
            const bool empty = g * n + l >= order.size();
            out.triangle.push_back(empty ? -1 : static_cast<Index>(order[g * n + l]));
            const ShellTriangle& t = shell.triangles[order[std::min(g * n + l, order.size() - 1)]];
            set_constants(t, out.constant.data() + g * kernel::elastic_constants * n + l);
            if (empty) {
                for (const std::size_t k : {std::size_t{5}, std::size_t{6}})
                    out.constant[(g * kernel::elastic_constants + k) * n + l] = 0.0;
                out.constant[(g * kernel::elastic_constants + 3) * n + l] = 1.0;  // the tangent divides by it
            }
            for (std::size_t s = 0; s < longest; ++s) {
                const bool filled = s < t.patch.size();
                const Index particle = filled ? t.patch[s] : t.patch[0];
                out.place[(first + s) * n + l] = 3 * particle;
                if (!filled || empty) continue;
                for (std::size_t k = 0; k < 3; ++k)
                    out.second[((first + s) * 3 + k) * n + l] = t.second[s][static_cast<Eigen::Index>(k)];
                of_particle[at(particle)].push_back(static_cast<std::int32_t>((first + s) * 3 * n + l));
            }
        }
    }
    for (std::size_t g = 0; g < groups; ++g) out.group_of_slot.resize(at(out.first_slot[g + 1]), static_cast<Index>(g));
    out.source_first.push_back(0);
    for (const std::vector<std::int32_t>& mine : of_particle) {
        out.source.insert(out.source.end(), mine.begin(), mine.end());
        out.source_first.push_back(static_cast<std::int32_t>(out.source.size()));
    }
    return out;
}

void ask_law(const ShellModel& shell, const ElasticGroups& groups, const Fibres& fibres, const AskLaw& law,
             std::span<const Vec3> x, std::span<double> out, std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g)
        for (std::size_t l = 0; l < n; ++l) {
            double* to = out.data() + g * 4 * n + l;
            to[0] = 1.0;
            to[n] = to[2 * n] = to[3 * n] = 0.0;
            if (groups.triangle[g * n + l] < 0) continue;
            const ShellTriangle& t = shell.triangles[at(groups.triangle[g * n + l])];
            const Eigen::Matrix2d e = shell_strain(t, x);
            MembranePoint elastic;
            elastic.c = Vec3(1.0 + 2.0 * e(0, 0), 1.0 + 2.0 * e(1, 1), 2.0 * e(0, 1));
            MembranePoint point = elastic;
            point.index = g * n + l;
            const MembraneMaterial material{t.mu_kpa, t.thinning, t.round};
            ask_elastic_law(material, fibres, elastic);
            law(material, point);
            const Vec3 more = point.stress - point.at_once * elastic.stress;
            to[0] = point.at_once;
            for (std::size_t k = 0; k < 3; ++k) to[(k + 1) * n] = more[static_cast<Eigen::Index>(k)];
        }
}

std::vector<double> holding_stiffness(const ShellModel& shell, std::span<const Vec3> rest) {
    const Eigen::SparseMatrix<double> k = shell_stiffness(shell, rest);
    std::vector<double> hold(shell.particles, 0.0);
    // Half the sum of what holds it and what ties it to others: Gershgorin's bound on the shape of k.
    for (Eigen::Index column = 0; column < k.outerSize(); column += 3)
        for (Eigen::SparseMatrix<double>::InnerIterator it(k, column); it; ++it) {
            if (it.row() % 3 != 0) continue;
            Mat3 block;
            for (Eigen::Index r = 0; r < 3; ++r)
                for (Eigen::Index c = 0; c < 3; ++c) block(r, c) = k.coeff(it.row() + r, column + c);
            const Index i = static_cast<Index>(it.row() / 3), j = static_cast<Index>(column / 3);
            if (i == j) block = block.selfadjointView<Eigen::Lower>();
            const double size = 0.5 * std::sqrt(block.squaredNorm());
            hold[at(i)] += size;
            if (i != j) hold[at(j)] += size;
        }
    Eigen::VectorXd inverse_root(k.rows()), v(k.rows());
    for (Eigen::Index r = 0; r < k.rows(); ++r) {
        const double h = hold[static_cast<std::size_t>(r / 3)];
        inverse_root[r] = h > 0.0 ? 1.0 / std::sqrt(h) : 0.0;
        v[r] = 1.0 + 0.5 * det::sin(static_cast<double>(r * r % 1009));
    }
    double eigenvalue = 0.0;
    for (int round = 0; round < power_rounds; ++round) {
        v.normalize();
        const Eigen::VectorXd scaled = inverse_root.cwiseProduct(v);
        const Eigen::VectorXd next = inverse_root.cwiseProduct(k.selfadjointView<Eigen::Lower>() * scaled);
        eigenvalue = next.norm();
        v = next;
    }
    for (double& h : hold) h *= safety * eigenvalue / largest_eigenvalue;
    // A particle that no triangle holds moves with the forces on it, never infinitely far.
    const double most = *std::max_element(hold.begin(), hold.end());
    for (double& h : hold)
        if (!(h > 0.0)) h = most;
    return hold;
}

void hold_now(const ElasticGroups& groups, std::span<const double> at_rest, std::span<const double> tangent,
              std::span<double> out, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
        double factor = 0.0;
        for (std::int32_t k = groups.source_first[i]; k < groups.source_first[i + 1]; ++k) {
            const std::size_t offset = at(groups.source[at(k)]);  // (slot x 3) x 8 + lane
            factor = std::max(factor, tangent[at(groups.group_of_slot[offset / (3 * n)]) * n + offset % n]);
        }
        out[i] = at_rest[i] * (factor > 0.0 ? factor : 1.0);
    }
}

}  // namespace cathlab
