#include "scene/wall_parameters.h"

#include <algorithm>

#include "core/errors.h"

namespace cathlab {

WallParameters wall_parameters(const SceneWall& wall) {
    constexpr double per_m3 = 1e-9;  // kg/m3 -> kg/mm3
    WallParameters out;
    out.density_kg_mm3 = wall.density_kg_m3 * per_m3;
    out.cluster_spacing_mm = wall.cluster_spacing_mm;
    out.cluster_radius_mm = wall.cluster_radius_mm;
    out.form = wall.form == "elastic" ? WallForm::elastic : WallForm::clusters;
    out.young_kpa = wall.young_kpa;
    out.poisson = wall.poisson;
    out.cluster_stiffness = wall.cluster_stiffness;
    out.damping_per_s = wall.damping_per_s;
    out.surrounding_kpa_per_mm = wall.surrounding_kpa_per_mm;
    out.surrounding_kpa_s_per_mm = wall.surrounding_kpa_s_per_mm;
    out.max_speed_mm_s = wall.max_speed_mm_s;
    out.precision = wall.precision == "double" ? Precision::double_ : Precision::float_;
    out.reference_spacing_mm = wall.particle_spacing_mm;
    return out;
}

std::vector<RegionWall> apply_wall(const SceneWall& wall, std::vector<Region>& regions) {
    std::vector<std::string> names;
    for (Region& region : regions) {
        names.push_back(region.name);
        region.particle_spacing_mm = std::min(region.particle_spacing_mm, wall.particle_spacing_mm);
    }
    std::vector<RegionWall> out;
    for (const SceneWallRegion& wanted : wall.regions) {
        const auto it = std::find(names.begin(), names.end(), wanted.name);
        if (it == names.end())
            throw UserError(wanted.where, "the anatomy has no region '" + wanted.name + "'; it has " +
                                              comma_list(names) + did_you_mean(wanted.name, names));
        Region& region = regions[static_cast<std::size_t>(it - names.begin())];
        region.particle_spacing_mm = wanted.particle_spacing_mm.value_or(region.particle_spacing_mm);
        region.wall_thickness_mm = wanted.wall_thickness_mm.value_or(region.wall_thickness_mm);
        region.force_limit_n = wanted.force_limit_n.value_or(region.force_limit_n);
        RegionWall& own = out.emplace_back();
        own.region = static_cast<Index>(it - names.begin());
        own.cluster_spacing_mm = wanted.cluster_spacing_mm;
        own.cluster_radius_mm = wanted.cluster_radius_mm;
        own.cluster_stiffness = wanted.cluster_stiffness;
        own.young_kpa = wanted.young_kpa;
        own.poisson = wanted.poisson;
    }
    for (Region& region : regions) region.force_limit_n *= wall.force_limit_share;
    return out;
}

}  // namespace cathlab
