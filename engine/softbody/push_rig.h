// A vessel held at some places, a rigid ball pushed into its wall from inside, a marker on its outside: what a bench or
// a finite-element model of a contact is, as an elastic shell at rest (softbody/shell.h).
//
// The shell is the wall's middle surface, half a thickness outside the lumen; so the ball is half a thickness larger.
// It touches without friction, on a bed of neo-Hookean bars as long as the wall is thick: what the wall gives way
// through its own thickness, which a shell does not know.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/mesh.h"
#include "softbody/membrane.h"
#include "softbody/shell.h"

namespace cathlab {

struct ShellFactors;

/// Where the wall is held: within radius_mm of center and within half_thickness_mm of the plane through it.
struct HeldDisc {
    Vec3 center = Vec3::Zero();
    Vec3 normal = Vec3::UnitZ();  ///< unit
    double radius_mm = 0.0, half_thickness_mm = 0.0;
};

struct PushRig {
    TriMesh lumen;  ///< mm, triangles outward; its ends may be open
    double thickness_mm = 1.0, young_kpa = 1000.0, poisson = 0.49;
    double ball_radius_mm = 2.5;
    std::vector<HeldDisc> held;
    double particle_spacing_mm = 2.5;
    /// Where the wall is looked at (the ball's places, the marker): away from them particles lie sparser, up to
    /// far_spacing_mm.  Empty = as dense everywhere.
    std::vector<Vec3> looked_at;
    double far_spacing_mm = 0.0;
    std::uint64_t seed = 1;
};

/// One push: where the ball's centre is, sample by sample, and the marker's place on the outside at rest.
struct Push {
    std::vector<Vec3> ball_mm;
    Vec3 marker_mm = Vec3::Zero();
    bool keep_wall = false;  ///< PushResult::wall_mm is wanted
    /// (samples) or empty: where the wall's particles are thought to be, each sample; the search begins beside them.
    std::span<const std::vector<Vec3>> guess = {};
    /// (samples) or empty: what a push along the same places with nearly the same law left of its searches; null ones
    /// are made.
    std::span<std::shared_ptr<ShellFactors>> factors = {};
};

struct PushResult {
    std::vector<Vec3> marker_mm;   ///< (samples)
    std::vector<double> force_mn;  ///< (samples) of the ball on the wall, along the line from its first to its farthest
                                   ///< place
    std::vector<std::vector<Vec3>> wall_mm = {};  ///< (samples) all particles, where the push asks for them
    bool at_rest = true;  ///< false where a sample did not come to rest: it and those after it are NaN
};

/// What effects make of the wall: asked sample by sample, in order.  A member that is empty changes nothing.
struct PushedLaw {
    std::function<void(std::size_t sample)> begin;  ///< before a sample is solved
    Fibres fibres = {};
    double support_kpa_per_mm = 0.0;  ///< an elastic foundation round the wall
    std::function<void(const MembraneMaterial&, MembranePoint&)> membrane;
    std::function<void(const MembranePoint&)> remember;  ///< empty = the law keeps nothing from sample to sample
    /// How far what holds the wall gives way under a traction (kPa of the section) at held particle i, mm.
    std::function<Vec3(std::size_t i, const Vec3& traction)> slip;
    std::function<void(std::size_t i, const Vec3& traction)> remember_slip;
};

/// The rig built: const, may be used by many threads.
class PushedWall {
public:
    /// Throws UserError: nothing to hold, numbers out of range, a mesh without triangles.
    explicit PushedWall(const PushRig& rig);

    /// Samples are solved in order, each from the one before; a place of the ball met before is taken from there.
    /// go_on: asked before every sample; false ends the push as if it had not come to rest.
    PushResult push(const Push& push, const std::function<bool()>& go_on = {}) const;
    /// The same with a law of effects: it is asked within the search for rest; what holds the wall is let slip between
    /// searches until it no longer moves.
    PushResult push(const Push& push, const PushedLaw& law, const std::function<bool()>& go_on = {}) const;
    std::size_t triangles() const { return shell_.triangles.size(); }

    std::size_t particles() const { return shell_.particles; }

private:
    class Sample;
    std::vector<Vec3> rest_;
    std::vector<double> area_mm2_;
    std::vector<double> holding_;  // (n) mN/mm of held particles; of the others 0
    double thickness_mm_ = 1.0;
    std::vector<std::uint8_t> fixed_;
    ShellModel shell_;
    double ball_radius_mm_ = 0.0, spacing_mm_ = 0.0, young_kpa_ = 0.0;
};

/// A straight open tube about z from 0, its mesh fine enough for the spacing.
TriMesh straight_lumen(double radius_mm, double length_mm, double spacing_mm);

}  // namespace cathlab
