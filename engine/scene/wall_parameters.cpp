#include "scene/wall_parameters.h"

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

}  // namespace cathlab
