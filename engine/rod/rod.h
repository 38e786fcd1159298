// The guidewire: a chain of rigid capsules in a Bullet world, fed in through a sheath, its joints solved all at once.
// Link 0 is the wire's tip; a link's z axis points to the tip.  Links behind the sheath's mouth are held by the sheath.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "core/archive.h"
#include "core/parallel.h"
#include "core/types.h"
#include "rod/chain_row.h"
#include "rod/sleeve_spec.h"
#include "rod/wire_spec.h"

namespace cathlab {

/// The straight tube through which the wire enters: links behind its mouth move along its z axis only.
struct SheathPose {
    Pose mouth;                ///< z points into the vessel
    double length_mm = 100.0;  ///< how much of the wire behind the mouth is kept in the chain, > 0
};

/// A point of the wire's surface or axis where it may touch something: the sphere of `radius` round `position`.
struct RodSample {
    Index link = 0;
    Vec3 arm = Vec3::Zero();       ///< from the link's centre, world, mm
    Vec3 position = Vec3::Zero();  ///< world, mm
    double radius = 0.0;           ///< mm
};

class Rod {
public:
    /// Lays the wire along initial_path (world; from the sheath inward; straight on from its end, straight from the
    /// mouth if empty) without stretch, at rest.  initial_insertion_mm is clamped to the legal range (see
    /// insertion_mm). Throws UserError for a spec that validate() refuses, std::logic_error for a sheath or path that
    /// is not finite.
    Rod(const WireSpec& spec, const SheathPose& sheath, double initial_insertion_mm,
        std::span<const Vec3> initial_path = {});
    /// The same with a passive catheter over the wire (coaxial.h): one chain in which EI, GJ and EA add.  Either is
    /// moved by its own grip and may lead; the chain's links are then the wire's alone in front and the catheter's
    /// behind. Rotation: the chain behind the catheter's tip turns with the catheter, the wire beyond it by the
    /// difference of the two grips more, less what friction between them holds back.
    Rod(const WireSpec& spec, const SleeveSpec& sleeve, const SheathPose& sheath, double wire_insertion_mm,
        double sleeve_insertion_mm, std::span<const Vec3> initial_path = {});
    ~Rod();
    Rod(Rod&&) noexcept;
    Rod& operator=(Rod&&) noexcept;

    /// Puts the sheath's mouth elsewhere for the substep that follows, before command(); what it holds goes along.
    /// No part of the archive: whoever moves it says where it is in every substep.
    void move_mouth(const Pose& mouth);

    /// Moves what the sheath holds, inward positive and right-handed about the mouth's z, over the substep that
    /// follows. An advance beyond max_travel_mm(), a turn beyond 0.5 rad and an insertion out of range are clamped;
    /// what is not finite counts as zero.  Returns the advance that was taken, mm.
    double command(double advance_mm, double rotate_rad);

    /// The same for the catheter's grip; without a catheter nothing moves.
    double command_sleeve(double advance_mm, double rotate_rad);

    /// Starts a substep of h seconds: x~ = x + h v, q~ = exp(h w) q for every free link, the travel of a link limited
    /// to max_travel_mm() and its turn to 0.5 rad by scaling its velocity.  link_force: external force on the centre of
    /// each link [mN], at most link_count() entries, tip first; it acts in solve() and not in the prediction.
    void predict(double h, std::span<const Vec3> link_force = {}, const Workers& workers = Workers());

    /// One Newton step of implicit Euler for the whole chain, from the current (inside the iteration) poses:
    ///   (M / h^2 + M d / h + sum J^T K J + rows) (dx, dtheta) = right-hand side,
    /// block tridiagonal in 6 unknowns a link, solved by block Cholesky in O(n), the same bits on any threads.  Rows on
    /// links that the sheath holds see a link that does not give way.  On return each row's multiplier and
    /// tangent_force are the forces that this very system contained, so that momentum is exact however far the
    /// iteration has come. Throws std::logic_error for a row that is not finite, names no link, or has compliance <= 0.
    void solve(double h, std::span<ChainRow> rows, const Workers& workers = Workers());

    /// Ends the substep: velocities = motion / h; the Bullet bodies take poses and velocities.
    void finish(double h, const Workers& workers = Workers());

    /// Links in the chain now, those in the sheath included, and how many of them are free (links 0 .. free - 1).
    std::size_t link_count() const;
    std::size_t free_link_count() const;
    Pose link_pose(std::size_t i) const;
    Vec3 link_velocity(std::size_t i) const;  ///< of the centre at the end of the last substep, mm/s
    double link_length(std::size_t i) const;  ///< mm
    double link_radius(std::size_t i) const;  ///< mm
    double link_mass(std::size_t i) const;    ///< kg
    const std::string& material(std::size_t i) const;

    Vec3 tip() const;                    ///< front end of the wire (of link 0, unless a catheter leads), world
    std::vector<Vec3> polyline() const;  ///< front end of link 0, then the rear end of each link in the chain

    /// Material beyond the mouth, mm; from the length of the first two links to the wire's less its last link.
    double insertion_mm() const;
    double rotation_rad() const;  ///< of the sheath's grip, since the start
    double min_insertion_mm() const;
    double max_insertion_mm() const;

    /// What the sheath does to the free wire, from the last solve: force [mN, world], its part along the mouth's z
    /// (positive when the hand pushes inward) and the torque about that axis [mN mm].
    Vec3 sheath_reaction_mn() const;
    double sheath_force_mn() const;
    double sheath_torque_mn_mm() const;

    /// The catheter over the wire; without one: false, 0 and the wire's tip.
    bool has_sleeve() const;
    const SleeveSpec& sleeve_spec() const;  ///< throws std::logic_error without one
    std::size_t front_count() const;        ///< links 0 .. front_count() - 1 are wire that is ahead of the catheter
    double sleeve_insertion_mm() const;     ///< of the catheter beyond the mouth, 0 to its length less its last link
    double sleeve_rotation_rad() const;     ///< of its grip, since the start
    Vec3 sleeve_tip() const;                ///< world
    /// How the hands share sheath_reaction_mn() along the mouth's z: sheath_force_mn() is then the wire's hand, this
    /// the catheter's.  The wire's carries what the wire ahead of the catheter is pressed with, and what it takes to
    /// slide.
    double sleeve_force_mn() const;
    /// Sum of what wire and catheter press on each other, mN: steps of the shear force of the wire's own bending
    /// moment. Times wire_friction it is the force that the wire needs to slide, and it lets the wire's tip lag behind
    /// its grip by the twist that this friction winds up.
    double sleeve_load_mn() const;
    double sleeve_play_rad() const;  ///< that lag, either way

    /// What blood does to the free wire, from the last solve, mN: damping_per_s, the brake on a link that would travel
    /// further than max_travel_mm(), and the side drag in a contact (chain_rows.h).  Rows, sheath, link_force and this
    /// make up the wire's change of momentum exactly, but for a prediction that was shortened.
    Vec3 drag_mn() const;

    double max_stretch() const;  ///< largest opening of a free joint over the material that it stands for
    double energy_uj() const;    ///< kinetic energy plus that of the joints
    static double max_travel_mm() { return 0.8; }  ///< a free link's predicted travel in a substep, and an advance

    /// Points at most spacing_mm apart along the part of the wire that is beyond the mouth, tip first, each joint once.
    void samples(double spacing_mm, std::vector<RodSample>& out) const;

    const WireSpec& spec() const;
    const SheathPose& sheath() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    friend void visit(Archive& archive, Rod& rod);
};

/// Poses, velocities, insertion, rotation and the joints' tensions.
void visit(Archive& archive, Rod& rod);

}  // namespace cathlab
