#include "step/parts.h"

#include "core/check.h"

namespace cathlab {

Parts find_parts(World& world) {
    Parts p;
    p.world = &world;
    p.settings = world.first<StepSettings>();
    p.events = world.first<EventLog>();
    p.force_bar = world.first<ForceBar>();
    p.probe = world.first<StageProbe>();
    if (const auto* anatomy = world.first<Shared<AnatomyModel>>()) p.anatomy = anatomy->get();
    if (const auto* wall = world.first<Shared<SoftBodyModel>>()) p.wall = wall->get();
    if (const auto* surface = world.first<Shared<LumenSurfaceModel>>()) p.surface = surface->get();
    p.wall_state = world.first<SoftBodyState>();
    p.wall_scratch = world.first<SoftBodyScratch>();
    p.surface_state = world.first<LumenSurfaceState>();
    p.annulus = world.first<AnnulusRing>();
    p.supports = world.first<SupportState>();
    p.contacts = world.first<ContactSet>();
    CATHLAB_CHECK(p.settings && p.events && p.force_bar, "the world lacks its settings, event log or force bar");
    CATHLAB_CHECK(p.anatomy && p.wall && p.surface && p.wall_state && p.wall_scratch && p.surface_state && p.supports &&
                      p.contacts,
                  "the world lacks a part of its vessel");

    p.wire = world.first<Rod>();
    p.wire_drive = world.first<WireDrive>();
    p.wire_mouth = world.first<WallPlace>();
    p.catheter = world.first<CatheterSpec>();
    p.mount = world.first<CatheterMount>();
    p.catheter_state = world.first<CatheterState>();
    p.catheter_route = world.first<CatheterRoute>();
    p.heart = world.first<HeartSpec>();
    p.heart_state = world.first<HeartState>();
    p.heart_contact = world.first<HeartContact>();
    p.beam = world.first<BeamSpec>();
    p.beam_state = world.first<BeamState>();
    if (const auto* thickness = world.first<Shared<BodyThickness>>()) p.thickness = thickness->get();
    if (const auto* contrast = world.first<Shared<ContrastModel>>()) p.contrast = contrast->get();
    p.contrast_state = world.first<ContrastState>();
    world.each<ActiveEffect>([&](Entity, ActiveEffect& active) { p.effects.push_back(&active); });
    return p;
}

void Parts::event(const std::string& kind, const std::string& entity, const std::string& message, double value) const {
    events->pending.push_back({world->step_index, world->time_s, kind, entity, message, value});
}

EffectContext effect_context(const Parts& parts, double time_s, double dt) {
    EffectContext context;
    context.time_s = time_s;
    context.dt = dt;
    context.seed = parts.world->seed();
    context.step = parts.world->step_index;
    context.wall_rest = parts.wall->rest;
    context.wall_position = parts.wall_state->x;
    context.wall_mass = parts.wall->mass;
    context.wall_fixed = parts.wall->fixed;
    if (parts.heart_state) {
        context.heart_phase = parts.heart_state->phase;
        context.heart_beats = parts.heart_state->beats;
        context.heart_beat_s = 60.0 / parts.heart->rate_bpm;
    }
    return context;
}

}  // namespace cathlab
