// What Rod hides: Bullet's world between substeps, and the working arrays of one substep.  Included by this room alone.
#pragma once

#include "rod/block_chain.h"
#include "rod/bullet_world.h"
#include "rod/chain_rows.h"
#include "rod/coaxial.h"
#include "rod/rod.h"

namespace cathlab {

inline constexpr double max_turn_rad = 0.5;  // of a link, or of a grip, in a substep

/// The catheter over the wire, and how either stands in the other.
struct SleeveState {
    SleeveSpec spec;
    std::vector<WireLink> wire, tube;                  // cut alone
    double wire_insertion = 0.0, wire_rotation = 0.0;  // of the wire's own grip
    double insertion = 0.0;                            // of the catheter; its rotation is that of the chain
    double turn = 0.0;  // of the wire in the catheter at the catheter's tip: the difference of the grips less the play
    double play = 0.0;  // by how much friction lets it lag, either way, rad
    double load_mn = 0.0;     // sum of what wire and catheter press on each other
    double slide_mm = 0.0;    // of the wire through the catheter since the last substep
    double rubbing_mn = 0.0;  // on the wire's grip, inward positive: what it needs to slide
};

/// A joint between link a (nearer to the tip) and b behind it, as it is now (chain_solve.cpp).
struct JointNow {
    Vec3 ta, tb, ra, rb, gap;
    Vec3 u, g;
    double twist = 0.0;  // c
    Vec3 moment;         // of bend and twist, on a
};

struct Rod::Impl {
    WireSpec spec;
    SheathPose sheath;
    std::vector<WireLink> links;          // the whole wire, or wire and catheter as one chain
    std::unique_ptr<SleeveState> sleeve;  // null = the wire alone
    std::size_t front = 0;                // with a catheter: so many links are the wire's alone
    BulletWorld world;                    // the part of it that is in the chain
    double insertion = 0.0;
    double rotation = 0.0;

    // One entry a link in the chain.
    std::vector<Vec3> x, x_start, x_predicted;
    std::vector<Quat> q, q_start, q_predicted;
    std::vector<Vec3> force;
    // One entry a joint of the whole wire: pull along the wire in the last solve, mN.  The joint behind link i is joint
    // i.
    std::vector<double> tension;
    Vec3 sheath_reaction = Vec3::Zero();
    double sheath_torque = 0.0;
    Vec3 drag = Vec3::Zero();

    BlockChain system;
    ChainRows rows;
    std::vector<JointNow> joints;        // in a Newton step: those behind the free links, before it moves them
    std::vector<Vec3> opening;           // of each, by the linear system
    std::vector<std::uint8_t> to_build;  // 1 = the block must be built anew
    std::vector<Vec3> axis;              // of the free links
    std::vector<Mat6> diagonal;          // the blocks before rows and brakes
    std::vector<Vec6> right;
    std::vector<double> brake;        // mN/mm against a link's travel, see update_brakes
    std::vector<double> swing_brake;  // mN mm per rad against its swing in a Newton step

    std::size_t count() const { return x.size(); }
    std::size_t free_count() const;
    /// Where the sheath holds link i when `insertion` mm of wire stand beyond its mouth, turned by `rotation`.
    Pose held_pose(std::size_t i, double insertion, double rotation) const;
    /// Links in the chain at an insertion: the free ones, and those that the sheath holds over its length.
    std::size_t chain_length(double insertion) const;
    void grow(std::size_t count, double insertion, double rotation);
    void begin(const WireSpec& wire, const SheathPose& grip, std::span<const Vec3> path);
    /// Lays what is free along a path, at rest.
    void lay(std::span<const Vec3> path);
    void update_joints();
    void assemble(double h, const Workers& workers);
    void assemble_link(std::size_t i, double h);
    void add_rows_and_brakes(std::size_t i);
    bool update_brakes(std::size_t i, double h);
    void apply_solution(double h, const Workers& workers);
    void close_joints();
    void newton_step(double h, std::span<ChainRow> rows, const Workers& workers);
    void carry_on(std::span<ChainRow> now, std::span<const ChainRow> before) const;

    // With a catheter (rod_sleeve.cpp).
    void slide(double wire_insertion, double sleeve_insertion, double sleeve_rotation);
    std::vector<BodyMotion> reshaped(const Coaxial& next, double wire_insertion, double sleeve_insertion) const;
    void measure_rubbing(double h);
    double wire_force_mn() const;
};

}  // namespace cathlab
