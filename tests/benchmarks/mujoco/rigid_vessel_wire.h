// A wire in a vessel that does not give way, as MuJoCo's users build them: a chain of capsules with hinges and springs,
// in rings of boxes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/types.h"
#include "rod/wire_spec.h"

namespace cathlab {

/// The way of the wire and the lumen's radius along it, mm: from behind the sheath to beyond where its tip will come.
struct LumenWay {
    std::vector<Vec3> points;
    std::vector<double> radius;
};

struct PeerOptions {
    int links = 80;
    double wire_mm = 640.0;  ///< of the chain, from the way's beginning
    double timestep_s = 0.002;
    double ring_mm = 5.0;     ///< from ring to ring
    int boxes_per_ring = 12;  ///< their inner faces touch the circle of the lumen from outside
    double friction = 0.1;
    double armature_steps = 1.0;  ///< of a joint, in k h^2 (see below)
    double impedance = 0.99;      ///< of contacts: MuJoCo's solimp, 0 to 0.9999
    bool twist = false;           ///< a third hinge a link, about its axis
    std::string solver = "Newton";
};

/// MuJoCo 2.2.2 integrates joint springs explicitly: one of stiffness k on inertia I lives while h < 2 sqrt(I / k).  A
/// link of 2 mm with EI = 1850 N mm2 has I = 1e-5 kg mm2 and k = 9e5 mN mm: h < 7 us.  At 2 ms each joint therefore
/// gets an added inertia ("armature") of armature_steps k h^2 and a damping of k h, which MuJoCo takes implicitly: what
/// an implicit spring would add to the mass matrix, and not what a wire weighs.
class RigidVesselWire {
public:
    /// Throws std::runtime_error with MuJoCo's own words where it refuses the model.
    RigidVesselWire(const LumenWay& way, const WireSpec& wire, const PeerOptions& options);
    ~RigidVesselWire();
    RigidVesselWire(const RigidVesselWire&) = delete;
    RigidVesselWire& operator=(const RigidVesselWire&) = delete;

    /// One timestep with the hand's speeds, mm/s and rad/s.
    void step(double advance, double turn);

    /// Lets the wire, laid along the middle without a load, find its own way: its stiffness grows to what it is over
    /// half of the time.  Let go at once it shoots through the wall.
    void settle(double seconds);

    int degrees_of_freedom() const;
    int boxes() const;
    int contacts() const;           ///< now
    int faults() const;             ///< warnings of a state that is not finite, or of full buffers
    double penetration_mm() const;  ///< deepest now, by MuJoCo's own contacts
    int outside() const;            ///< joints farther from the way than the lumen goes, by 1.5 mm
    double joint_gap_mm() const;    ///< largest distance now of a link's end from the next one's beginning
    double fed_mm() const;          ///< by the slide, since the beginning
    double armature_min() const { return armature_min_; }  ///< kg mm2
    double armature_max() const { return armature_max_; }
    double armature_ratio() const { return armature_ratio_; }  ///< largest, in the link's own inertia about its joint

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    LumenWay lumen_;
    double link_mm_ = 0.0, fed_ = 0.0, turned_ = 0.0;
    double armature_min_ = 1e300, armature_max_ = 0.0, armature_ratio_ = 0.0;
};

}  // namespace cathlab
