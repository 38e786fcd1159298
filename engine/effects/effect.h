// Optional physics.  An effect is one file here and one line in effects.inl; from its EffectInfo it appears in scene
// files, `cathlab list effects`, the calibrator's parameters, the tracer's candidates and the docs.
//
// Hooks, in the order in which a step calls them:
//   input       between the operator's command and the device
//   drive       moves supports and the heart
//   material    constitutive: scales the wall's stiffness, particle by particle
//   constraint  anchors that the solver owns and evaluates inside its solve (never an explicit stiff force)
//   force       explicit, bounded forces on wall particles
//   measure     what a sensor would read: the channels, last of all
// An effect that a scene does not name is never called: the world is bit-identical to one that never heard of it.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/archive.h"
#include "core/channels.h"
#include "core/input.h"
#include "core/parameter.h"
#include "core/types.h"

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
};

/// `drive`: where the supports go and how the heart is paced.
struct Drive {
    /// (n) where fixed particles, and the tissue around the others, go: displacement from rest, mm
    std::vector<Vec3> support_displacement;
    double heart_rate_scale = 1.0;
    double heart_displacement_mm = 0.0;  ///< added to the cylinder's displacement
};

/// `constraint`: a linear spring from one particle to a target, taken implicitly inside the solve.
struct WallAnchor {
    Index particle = 0;
    Vec3 target = Vec3::Zero();  ///< mm, world
    double stiffness = 0.0;      ///< mN/mm, > 0
};

class Effect {
public:
    virtual ~Effect() = default;
    virtual void input(const EffectContext& /*context*/, Input& /*input*/) {}
    virtual void drive(const EffectContext& /*context*/, Drive& /*drive*/) {}
    virtual void material(const EffectContext& /*context*/, std::span<double> /*stiffness_scale: (n), 1 = as built*/) {}
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
};

struct EffectInfo {
    std::string_view name;
    std::string_view doc;
    std::string_view source;  ///< a key of docs/references.md, or "" for an effect that exists for tests alone
    unsigned hooks = 0;       ///< which hooks it uses
    bool for_tests = false;   ///< true: proves a hook; not offered to calibrator, tracer or `cathlab list`
    std::vector<std::string_view> applies_to;  ///< kinds of measured data that may show it
    std::vector<Parameter> parameters;
    std::unique_ptr<Effect> (*make)(std::span<const double> values) = nullptr;  ///< values in the order of `parameters`
};

/// All effects, in the order of effects.inl.
std::span<const EffectInfo> effect_table();

/// nullptr where there is none of that name.
const EffectInfo* find_effect(std::string_view name);

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
