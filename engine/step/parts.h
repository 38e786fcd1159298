// What a step works on: the components of a world, looked up once, and the small components that belong to the step
// itself.
#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "anatomy/model.h"
#include "beam/exposure.h"
#include "beam/thickness.h"
#include "catheter/mount.h"
#include "catheter/route.h"
#include "catheter/shape.h"
#include "catheter/wall_limit.h"
#include "contact/contact_set.h"
#include "contact/lumen_surface.h"
#include "contrast/transport.h"
#include "core/event.h"
#include "effects/effect.h"
#include "heart/cylinder_rows.h"
#include "heart/motion.h"
#include "rod/rod.h"
#include "softbody/binding.h"
#include "softbody/solver.h"
#include "softbody/wall_place.h"
#include "step/force_bar.h"
#include "step/step.h"
#include "world/step_settings.h"
#include "world/world.h"

namespace cathlab {

/// Devices as the contact room numbers them.
inline constexpr Index wire_device = 0;
inline constexpr Index catheter_device = 1;

/// Component of the vessel: the particles whose mean displacement along the heart's axis is the annulus' motion.
struct AnnulusRing {
    std::vector<Index> particles;
    std::vector<Index>
        candidates;  ///< those that the heart's cylinder may touch: the root, not the coronaries on the heart
    Vec3 axis = Vec3::UnitZ();
};

/// Component of the vessel: where the fixed particles, and the tissue around the others, stand, as displacements from
/// rest.
struct SupportState {
    std::vector<Vec3>
        displacement;  ///< (n) at the end of the last step; zero for free particles with nothing around them
};
inline void visit(Archive& archive, SupportState& state) {
    archive.field("displacement", state.displacement);
}

/// Component of the wire: what the drive at the sheath remembers.
struct WireDrive {
    double refused_mm = 0.0;      ///< sum of what was asked for and not taken
    double contact_mn = 0.0;      ///< largest contact force in the last substep
    double penetration_mm = 0.0;  ///< deepest penetration in the last substep, before what was too deep was pushed out
    double head_on_mn = 0.0;      ///< force on the front end against its own direction in the last substep
};
inline void visit(Archive& archive, WireDrive& drive) {
    archive.field("refused_mm", drive.refused_mm);
    archive.field("contact_mn", drive.contact_mn);
    archive.field("penetration_mm", drive.penetration_mm);
    archive.field("head_on_mn", drive.head_on_mn);
}

/// Component of the catheter beside CatheterSpec, CatheterState and CatheterMount.
struct CatheterRoute {
    RouteGraph graph;
    /// The path of the shaft: the centre-line as it was at rest.  The shaft has its own stiffness, and the wall slides
    /// over it; a rail that moved with each dent in the wall would carry the wire that makes the dent along, and run
    /// away with it.
    std::vector<Vec3> path;
    Rail laid;            ///< where its shaft lies: on its way to what route and wire ask for
    CatheterShape shape;  ///< where it lies now; follows from its state and `laid`, and from `yielded`
    /// Where an effect lets the tip yield (tip_yield.h): by how much it does, and where drive and rail alone put the
    /// catheter (no points = the same as `shape`).
    double tip_compliance_mm_per_n = 0.0;
    Vec3 yielded = Vec3::Zero();
    CatheterShape driven;
    /// In the last substep it was too deep in the wall at first: it goes slowly; and still in the end: it draws
    /// back.
    bool deep = false, stuck = false;
    /// What follows from the route alone, kept while that stays the same.
    std::vector<std::int64_t> rail_route;
    Rail rail;
    double insertion_limit_mm = 0.0;
};
inline void visit(Archive& archive, CatheterRoute& route) {
    archive.field("laid", route.laid.points);
    archive.field("lead", route.laid.lead);
    if (route.yielded != Vec3::Zero()) archive.field("yielded", route.yielded);
    if (route.deep) archive.field("deep", route.deep);
    if (route.stuck) archive.field("stuck", route.stuck);
}

/// Component of the heart: forces between cylinder and wall, kept from substep to substep as a warm start.
struct HeartContact {
    std::vector<double> force_mn;  ///< (n), one a particle
};
inline void visit(Archive& archive, HeartContact& contact) {
    archive.field("force_mn", contact.force_mn);
}

/// Everything by pointer; null where the scene has none.
struct Parts {
    World* world = nullptr;
    const StepSettings* settings = nullptr;
    EventLog* events = nullptr;
    ForceBar* force_bar = nullptr;
    const StageProbe* probe = nullptr;

    const AnatomyModel* anatomy = nullptr;
    const SoftBodyModel* wall = nullptr;
    SoftBodyState* wall_state = nullptr;
    SoftBodyScratch* wall_scratch = nullptr;
    const LumenSurfaceModel* surface = nullptr;
    LumenSurfaceState* surface_state = nullptr;
    AnnulusRing* annulus = nullptr;
    SupportState* supports = nullptr;
    ContactSet* contacts = nullptr;

    Rod* wire = nullptr;
    WireDrive* wire_drive = nullptr;
    const WallPlace* wire_mouth = nullptr;  ///< where the wire's mouth goes along with the wall
    const CatheterSpec* catheter = nullptr;
    const CatheterMount* mount = nullptr;
    CatheterState* catheter_state = nullptr;
    CatheterRoute* catheter_route = nullptr;
    const HeartSpec* heart = nullptr;
    HeartState* heart_state = nullptr;
    HeartContact* heart_contact = nullptr;
    const BeamSpec* beam = nullptr;
    BeamState* beam_state = nullptr;
    const BodyThickness* thickness = nullptr;
    const ContrastModel* contrast = nullptr;
    ContrastState* contrast_state = nullptr;
    std::vector<ActiveEffect*> effects;  ///< in the order of their entities

    /// Calls f(effect) for the effects that use a hook.
    template <class F>
    void each_effect(Hook hook, F&& f) const {
        for (ActiveEffect* active : effects)
            if (active->info->hooks & hook) f(*active->effect);
    }

    void stage(std::string_view room) const {
        if (probe && probe->begin) probe->begin(room);
    }
    void event(const std::string& kind, const std::string& entity, const std::string& message, double value) const;
};

/// Throws std::logic_error where a component that every world needs is missing (see prepare in step.h).
Parts find_parts(World& world);

/// The context in which effects are asked, at a time within the step.
EffectContext effect_context(const Parts& parts, double time_s, double dt);

}  // namespace cathlab
