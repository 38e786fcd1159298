#include "explain/wall_contact.h"

#include "anatomy/mesh_file.h"

namespace cathlab {

PushRig push_rig_of(const WallContactSetup& setup, double spacing_mm) {
    PushRig rig;
    rig.lumen = setup.mesh.empty() ? straight_lumen(setup.tube_radius_mm, setup.tube_length_mm, spacing_mm)
                                   : load_mesh(setup.mesh, "mm", setup.mesh_place);
    rig.thickness_mm = setup.thickness_mm;
    rig.young_kpa = setup.young_modulus_kpa;
    rig.poisson = setup.poisson;
    rig.ball_radius_mm = setup.tool_radius_mm;
    for (const HeldPlace& held : setup.held)
        rig.held.push_back({held.center_mm, held.normal, held.radius_mm, held.half_thickness_mm});
    rig.particle_spacing_mm = spacing_mm;
    return rig;
}

}  // namespace cathlab
