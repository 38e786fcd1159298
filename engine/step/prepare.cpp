#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "step/actuation.h"
#include "step/catheter_drive.h"
#include "step/parts.h"
#include "step/step.h"

namespace cathlab {
namespace {

// A node hangs on the ring of particles around it: more than a point of the surface needs, so that it stays in the
// middle.
// Particles whose mean motion is the annulus' motion: those within this distance of the ring.
constexpr double ring_mm = 2.5;
// The cylinder may touch the root this far beyond the annulus, along the axis, mm.
constexpr double root_mm = 12.0;

AnnulusRing find_ring(const AnatomyModel& anatomy, const SoftBodyModel& wall) {
    AnnulusRing ring;
    const Pose& pose = anatomy.annulus->pose;
    const double radius = anatomy.annulus->radius_mm;
    ring.axis = pose.orientation * Vec3::UnitZ();
    for (std::size_t i = 0; i < wall.size(); ++i) {
        const Vec3 local = pose.to_local(wall.rest[i]);
        const double across = std::sqrt(local.x() * local.x() + local.y() * local.y());
        const double off = std::sqrt((across - radius) * (across - radius) + local.z() * local.z());
        if (off < ring_mm) ring.particles.push_back(static_cast<Index>(i));
        if (across < 1.6 * radius && std::fabs(local.z()) < root_mm && !wall.fixed[i])
            ring.candidates.push_back(static_cast<Index>(i));
    }
    return ring;
}

}  // namespace

void prepare(World& world) {
    if (world.first<SupportState>()) return;
    const auto* settings = world.first<StepSettings>();
    const auto* anatomy = world.first<Shared<AnatomyModel>>();
    const auto* wall = world.first<Shared<SoftBodyModel>>();
    CATHLAB_CHECK(settings && anatomy && wall, "a scene's world has settings, an anatomy and a wall");
    const std::size_t n = (*wall)->size();

    const Entity top = world.owner<StepSettings>();
    if (!world.get<EventLog>(top)) world.add(top, EventLog{});
    world.add(top, ForceBar::with_filter(settings->force_filter_s, settings->dt));

    const Entity vessel = world.owner<Shared<AnatomyModel>>();
    world.add(vessel, SoftBodyScratch{});
    world.add(vessel, LumenSurfaceState{});
    world.add(vessel, SupportState{std::vector<Vec3>(n, Vec3::Zero())});
    ContactSettings contact;
    // Neighbours of a sample see the other walls: a few rows are enough.
    contact.rows_per_sample = 3;
    contact.recovery_mm = 8.0;
    world.add(vessel, ContactSet(contact));
    update(**world.first<Shared<LumenSurfaceModel>>(), world.first<SoftBodyState>()->x,
           *world.first<LumenSurfaceState>(), world.workers());

    if (world.first<Rod>()) world.add(world.owner<Rod>(), WireDrive{});
    if (world.first<HeartSpec>()) {
        CATHLAB_CHECK((*anatomy)->annulus, "a heart needs an annulus");
        world.add(world.owner<HeartSpec>(), HeartContact{std::vector<double>(n, 0.0)});
        world.add(vessel, find_ring(**anatomy, **wall));
    }
    if (const auto* mount = world.first<CatheterMount>()) {
        const Entity catheter = world.owner<CatheterMount>();
        CatheterRoute route;
        route.graph = build_route_graph((*anatomy)->centreline, mount->entry, mount->mouth);
        for (const CentrelineNode& node : (*anatomy)->centreline.nodes) route.path.push_back(node.position);
        world.add(catheter, std::move(route));
        Parts parts = find_parts(world);
        const bool actuated = std::any_of(parts.effects.begin(), parts.effects.end(), [](const ActiveEffect* active) {
            return (active->info->hooks & hook_actuation) != 0;
        });
        settle_catheter(parts);
        if (actuated) {
            const double start = parts.catheter_state->insertion_mm, turned = parts.catheter_state->rotation_rad;
            world.add(catheter, CatheterTravel{start, turned, start, turned});
        }
    }
}

}  // namespace cathlab
