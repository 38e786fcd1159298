#include "softbody/model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/check.h"
#include "core/errors.h"
#include "softbody/clusters.h"

namespace cathlab {

namespace {

constexpr double largest_stiffness = 0.999;  // t_c = 1 would be an infinite stiffness, which has no compliance to share

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

void require(bool good, const std::string& name, double found, const std::string& allowed) {
    if (!good) throw UserError("wall: " + name + " = " + std::to_string(found) + "; it must be " + allowed);
}

void check_positive(const std::string& name, double value) {
    require(value > 0.0 && std::isfinite(value), name, value, "above 0");
}

void check_stiffness(const std::string& name, double value) {
    require(value >= 0.0 && value <= largest_stiffness, name, value, "between 0 and 0.999");
}

void check_poisson(const std::string& name, double value) {
    require(value >= 0.0 && value <= 0.4999, name, value, "between 0 and 0.4999");
}

void check(const WallParameters& p) {
    check_positive("density_kg_mm3", p.density_kg_mm3);
    check_positive("cluster_spacing_mm", p.cluster_spacing_mm);
    check_positive("cluster_radius_mm", p.cluster_radius_mm);
    check_positive("reference_spacing_mm", p.reference_spacing_mm);
    check_stiffness("cluster_stiffness", p.cluster_stiffness);
    check_positive("young_kpa", p.young_kpa);
    check_poisson("poisson", p.poisson);
    require(p.surrounding_kpa_per_mm >= 0.0 && std::isfinite(p.surrounding_kpa_per_mm), "surrounding_kpa_per_mm",
            p.surrounding_kpa_per_mm, "0 or above");
    require(p.surrounding_kpa_s_per_mm >= 0.0 && std::isfinite(p.surrounding_kpa_s_per_mm), "surrounding_kpa_s_per_mm",
            p.surrounding_kpa_s_per_mm, "0 or above");
    require(p.damping_per_s >= 0.0 && std::isfinite(p.damping_per_s), "damping_per_s", p.damping_per_s, "0 or above");
    require(p.max_speed_mm_s > 0.0, "max_speed_mm_s", p.max_speed_mm_s, "above 0");
    for (const RegionWall& own : p.regions) {
        if (own.young_kpa) check_positive("young_kpa of a region", *own.young_kpa);
        if (own.poisson) check_poisson("poisson of a region", *own.poisson);
        if (own.cluster_spacing_mm) check_positive("cluster_spacing_mm of a region", *own.cluster_spacing_mm);
        if (own.cluster_radius_mm) check_positive("cluster_radius_mm of a region", *own.cluster_radius_mm);
        if (own.density_kg_mm3) check_positive("density_kg_mm3 of a region", *own.density_kg_mm3);
        if (own.cluster_stiffness) check_stiffness("cluster_stiffness of a region", *own.cluster_stiffness);
    }
}

Index root(std::vector<Index>& parent, Index i) {
    while (parent[at(i)] != i) {
        parent[at(i)] = parent[at(parent[at(i)])];
        i = parent[at(i)];
    }
    return i;
}

std::vector<FreeBody> find_free_bodies(const Membership& membership, const std::vector<std::uint8_t>& fixed) {
    std::vector<Index> parent(fixed.size());
    std::iota(parent.begin(), parent.end(), 0);
    for (const auto& members : membership)
        for (const Index i : members) {
            const Index a = root(parent, members.front()), b = root(parent, i);
            parent[at(std::max(a, b))] = std::min(a, b);
        }
    std::vector<std::uint8_t> held(fixed.size(), 0);
    for (std::size_t i = 0; i < fixed.size(); ++i)
        if (fixed[i]) held[at(root(parent, static_cast<Index>(i)))] = 1;
    std::vector<FreeBody> bodies;
    std::vector<Index> body_of(fixed.size(), -1);
    for (std::size_t i = 0; i < fixed.size(); ++i) {
        const std::size_t r = at(root(parent, static_cast<Index>(i)));
        if (held[r]) continue;
        if (body_of[r] < 0) {
            body_of[r] = static_cast<Index>(bodies.size());
            bodies.emplace_back();
        }
        bodies[at(body_of[r])].particles.push_back(static_cast<Index>(i));
    }
    return bodies;
}

/// A triangle has the mean of its corners' numbers: where two regions meet the wall changes over one triangle.
void make_elastic(const WallSample& sample, const WallParameters& parameters, SoftBodyModel& model) {
    if (sample.triangles.empty())
        throw UserError("wall: the elastic form wants a wall of triangles; this one has none");
    std::vector<double> young(model.size(), parameters.young_kpa), poisson(model.size(), parameters.poisson);
    for (std::size_t i = 0; i < model.size(); ++i)
        for (const RegionWall& own : parameters.regions)
            if (own.region == sample.region[i]) {
                young[i] = own.young_kpa.value_or(young[i]);
                poisson[i] = own.poisson.value_or(poisson[i]);
            }
    std::vector<ShellMaterial> material;
    for (const Triangle& t : sample.triangles) {
        ShellMaterial m{0.0, 0.0, 0.0};
        for (int k = 0; k < 3; ++k) {
            m.young_kpa += young[at(t[k])] / 3.0;
            m.poisson += poisson[at(t[k])] / 3.0;
            m.thickness_mm += sample.thickness_mm[at(t[k])] / 3.0;
        }
        material.push_back(m);
    }
    model.shell = build_shell(sample.position, sample.triangles, material, {.along = sample.along});
    model.elastic = pack_shell(model.shell);
    model.stiffness = holding_stiffness(model.shell, model.rest);
}

}  // namespace

SoftBodyModel build_soft_body(const WallSample& sample, const WallParameters& parameters,
                              const std::function<bool(const Vec3&)>& is_fixed) {
    check(parameters);
    const std::size_t n = sample.position.size();
    if (n == 0) throw UserError("the wall has no particles");
    CATHLAB_CHECK(sample.area_mm2.size() == n && sample.thickness_mm.size() == n && sample.region.size() == n,
                  "one area, thickness and region a particle");
    SoftBodyModel model;
    model.rest = sample.position;
    model.normal = sample.normal;
    model.normal.resize(n, Vec3::Zero());
    model.region = sample.region;
    model.area_mm2 = sample.area_mm2;
    model.thickness_mm = sample.thickness_mm;
    model.links = sample.links;
    model.damping_per_s = parameters.damping_per_s;
    model.max_speed_mm_s = parameters.max_speed_mm_s;
    model.precision = parameters.precision;
    for (std::size_t i = 0; i < n; ++i) {
        double density = parameters.density_kg_mm3, t_c = parameters.cluster_stiffness;
        for (const RegionWall& own : parameters.regions) {
            if (own.region != sample.region[i]) continue;
            density = own.density_kg_mm3.value_or(density);
            t_c = own.cluster_stiffness.value_or(t_c);
        }
        const double mass = density * sample.area_mm2[i] * sample.thickness_mm[i];
        CATHLAB_CHECK(mass > 0.0, "a wall particle without mass");
        model.mass.push_back(mass);
        model.stiffness.push_back(mass / (reference_step_s * reference_step_s) * t_c / (1.0 - t_c));
        if (parameters.surrounding_kpa_per_mm > 0.0)
            model.support.push_back(parameters.surrounding_kpa_per_mm * sample.area_mm2[i]);
        if (parameters.surrounding_kpa_s_per_mm > 0.0)
            model.drag.push_back(parameters.surrounding_kpa_s_per_mm * sample.area_mm2[i]);
        model.fixed.push_back(is_fixed && is_fixed(sample.position[i]) ? 1 : 0);
    }
    model.form = parameters.form;
    if (model.form == WallForm::elastic) make_elastic(sample, parameters, model);
    const Membership membership = grow_clusters(sample, parameters);
    pack_clusters(membership, model);
    if (model.support.empty() && model.drag.empty()) model.free_bodies = find_free_bodies(membership, model.fixed);
    return model;
}

}  // namespace cathlab
