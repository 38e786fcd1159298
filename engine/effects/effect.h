// Optional physics.  An effect is one file here and one line in effects.inl; from its EffectInfo it appears in scene
// files, `cathlab list effects`, the calibrator's parameters, the tracer's candidates and the docs.
//
// Hooks, in the order in which a step calls them:
//   input       between the operator's command and the device
//   actuation   between the catheter's drive and its shape: cables, shaft, friction
//   drive       moves supports and the heart
//   material    constitutive: scales the wall's stiffness, particle by particle
//   membrane    constitutive: the elastic wall's law, point by point: strain that bears no stress, stress, memory
//   slip        how far what holds the wall gives way under what pulls at it
//   constraint  anchors that the solver owns and evaluates inside its solve (never an explicit stiff force)
//   force       explicit, bounded forces on wall particles
//   measure     what a sensor would read: the channels, last of all
// An effect that a scene does not name is never called: the world is bit-identical to one that never heard of it.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/archive.h"
#include "core/channels.h"
#include "core/input.h"
#include "core/parameter.h"
#include "core/types.h"
#include "softbody/fibres.h"
#include "softbody/membrane.h"

namespace cathlab {

/// What an effect may know.  Spans stay valid for the call alone.
struct EffectContext {
    double time_s = 0.0;                       ///< simulated time at the beginning of the (sub)step
    double dt = 0.0;                           ///< length of the (sub)step, s
    std::uint64_t seed = 0;                    ///< the world's, for counter-based random numbers
    std::int64_t step = 0;                     ///< steps done
    std::span<const Vec3> wall_rest;           ///< (n) rest positions of the wall's particles, mm
    std::span<const Vec3> wall_position;       ///< (n) where they are now
    std::span<const double> wall_mass;         ///< (n) kg
    std::span<const std::uint8_t> wall_fixed;  ///< (n) 1 = moves with the supports
    double heart_phase = 0.0;                  ///< of the beat at the beginning of the (sub)step, [0, 1)
    std::int64_t heart_beats = 0;              ///< beats completed since the start
    double heart_beat_s = 0.0;                 ///< usual length of a beat; 0 = there is no heart, or none is recorded
    /// Where beats were recorded: how long the one before this one took, in usual beats.  0 = the heart's own clock
    /// runs, and an effect may change it.
    double heart_interval = 0.0;
};

/// One segment of a steerable device as its drive bends it.
struct ActuatedSegment {
    double length_mm = 0.0;
    Vec2 bend_rad = Vec2::Zero();  ///< angle between its ends, towards x and y of the device's base frame
    /// How unevenly the bend lies along the segment: curvature (bend / length) (1 + taper (2 s / length - 1)); -1 = all
    /// at its base and none at its end.
    double taper = 0.0;
    double tendon_radius_mm = 0.0;
    std::vector<double> tendon_rad, tendon_mm;  ///< (tendons) place around the axis; length pulled at the drive
};

/// `actuation`: what drive, cables and shaft make of a command.  The hook is given what was commanded and leaves what
/// the device does.
struct Actuation {
    double insertion_mm = 0.0;              ///< of the base
    double rotation_rad = 0.0;              ///< of the base about its own axis
    std::vector<ActuatedSegment> segments;  ///< base first
    double link_length_mm = 0.0;            ///< straight, between neighbouring segments
    double tip_length_mm = 0.0;             ///< straight, after the last segment
    Vec3 down = Vec3::Zero();  ///< direction of gravity in the frame of the base (which turns with the rotation);
                               ///< zero = not known
    /// How far the tip yields under a force on it, in any direction; see step/tip_yield.h.
    double tip_compliance_mm_per_n = 0.0;
};

/// `drive`: where the supports go and how the heart is paced.
struct Drive {
    /// (n) where fixed particles, and the tissue around the others, go: displacement from rest, mm
    std::vector<Vec3> support_displacement;
    double heart_rate_scale = 1.0;
    double heart_displacement_mm = 0.0;  ///< added to the cylinder's displacement
    /// Of the beat's own displacement, counted from where the heart stands when a beat begins.
    double heart_amplitude_scale = 1.0;
};

/// `constraint`: a linear spring from one particle to a target, taken implicitly inside the solve.
struct WallAnchor {
    Index particle = 0;
    Vec3 target = Vec3::Zero();  ///< mm, world
    double stiffness = 0.0;      ///< mN/mm, > 0
};

/// `slip`: one place at which the wall is held.
struct HeldPoint {
    std::size_t index = 0;
    Vec3 traction = Vec3::Zero();  ///< of the wall on what holds it, kPa of the wall's section
    Vec3 slipped = Vec3::Zero();   ///< where what holds it has gone, mm: effects add to it
};

class RestOfWall;

class Effect {
public:
    virtual ~Effect() = default;
    virtual void input(const EffectContext& /*context*/, Input& /*input*/) {}
    virtual void actuation(const EffectContext& /*context*/, Actuation& /*actuation*/) {}
    virtual void drive(const EffectContext& /*context*/, Drive& /*drive*/) {}
    virtual void material(const EffectContext& /*context*/, std::span<double> /*stiffness_scale: (n), 1 = as built*/) {}
    /// `material` of an elastic wall: the fibres in it.
    virtual void fibres(const EffectContext& /*context*/, Fibres& /*fibres*/) {}
    /// `material`: adds to the foundation that holds each particle where its support stands.
    virtual void surroundings(const EffectContext& /*context*/, std::span<double> /*kpa_per_mm: (n), add to it*/) {}
    /// `membrane`: so many points there are; before any is asked.
    virtual void points(std::size_t /*count*/) {}
    /// Takes from point.c what bears no stress.  As stress(): no lasting change, for a solver may ask many times; calls
    /// for different points come from several threads.
    virtual void strain(const EffectContext& /*context*/, MembranePoint& /*point*/) {}
    /// Changes point.stress, which the elastic law has written with energy_kpa, and point.at_once where the wall is
    /// stiffer than that law when strained at once.
    virtual void stress(const EffectContext& /*context*/, MembranePoint& /*point*/) {}
    /// After all of these, of an effect that lies in series with the rest of the wall and has to bear what that bears:
    /// shares the strain at c out anew and writes `point`.  As stress().
    virtual void share(const EffectContext& /*context*/, const Vec3& /*c*/, const RestOfWall& /*rest*/,
                       MembranePoint& /*point*/) {}
    /// The (sub)step is over and has ended so.
    virtual void remember(const EffectContext& /*context*/, const MembranePoint& /*point*/) {}
    /// Adds to `slipped`; no lasting change, as stress().
    virtual void slip(const EffectContext& /*context*/, HeldPoint& /*held*/) {}
    virtual void remember_slip(const EffectContext& /*context*/, const HeldPoint& /*held*/) {}
    virtual void constraint(const EffectContext& /*context*/, std::vector<WallAnchor>& /*anchors*/) {}
    virtual void force(const EffectContext& /*context*/, std::span<Vec3> /*force: (n) mN, add to it*/) {}
    virtual void measure(const EffectContext& /*context*/, Channels& /*channels*/) {}
    /// The effect's own state, for the state hash.
    virtual void visit(Archive& /*archive*/) {}
};

enum Hook : unsigned {
    hook_input = 1U,
    hook_drive = 2U,
    hook_material = 4U,
    hook_constraint = 8U,
    hook_force = 16U,
    hook_measure = 32U,
    hook_actuation = 64U,
    hook_membrane = 128U,
    hook_slip = 256U,
};

struct EffectInfo {
    std::string_view name;
    std::string_view doc;
    std::string_view source;  ///< a key of docs/references.md, or "" for an effect that exists for tests alone
    unsigned hooks = 0;       ///< which hooks it uses
    bool for_tests = false;   ///< true: proves a hook; not offered to calibrator, tracer or `cathlab list`
    std::vector<std::string_view> applies_to;  ///< kinds of measured data that may show it
    std::vector<Parameter> parameters;
    /// Parameters that say how strong it is: with all of them 0 it does nothing, to the bit.
    std::vector<std::string_view> strengths = {};
    /// Parameters whose ends are meanings (none, every direction) and not a claim of how far a mechanism goes.
    std::vector<std::string_view> meant_ends = {};
    std::unique_ptr<Effect> (*make)(std::span<const double> values) = nullptr;  ///< values in the order of `parameters`
    bool elastic_wall = false;  ///< acts on the wall's elastic form alone; a scene with the other one is refused
};

/// The law of a membrane's point with effects in it: strain, elastic law, stress.
void ask_membrane(std::span<Effect* const> effects, const EffectContext& context, const MembraneMaterial& material,
                  const Fibres& fibres, MembranePoint& point);

/// The wall without what one effect takes of its strain.
class RestOfWall {
public:
    RestOfWall(std::span<Effect* const> effects, const EffectContext& context, const MembraneMaterial& material,
               const Fibres& fibres, const Effect& without)
        : effects_(effects), context_(context), material_(material), fibres_(fibres), without_(without) {}
    /// Strain, elastic law and stress of all others, at point.c.
    void ask(MembranePoint& point) const;
    double poisson() const { return material_.thinning / (1.0 + material_.thinning); }
    /// The elastic law alone.
    void ask_elastic(MembranePoint& point) const { ask_elastic_law(material_, fibres_, point); }

private:
    std::span<Effect* const> effects_;
    const EffectContext& context_;
    const MembraneMaterial& material_;
    const Fibres& fibres_;
    const Effect& without_;
};

/// All effects, in the order of effects.inl.
std::span<const EffectInfo> effect_table();

/// nullptr where there is none of that name.  Hyphens count as underscores: data sets write `actuation-lag`, scenes
/// and files `actuation_lag`.
const EffectInfo* find_effect(std::string_view name);

/// The name as data sets and reports write it: with hyphens.
std::string spoken_name(const EffectInfo& info);

/// "input, drive" for lists and docs.
std::vector<std::string_view> hook_names(unsigned hooks);

/// Component of an effect's entity.
struct ActiveEffect {
    const EffectInfo* info = nullptr;
    std::unique_ptr<Effect> effect;
};
inline void visit(Archive& archive, ActiveEffect& active) {
    active.effect->visit(archive);
}

}  // namespace cathlab
