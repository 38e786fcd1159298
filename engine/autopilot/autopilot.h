// An operator made of software: it follows the centre-line to a task's goal, steers, and backs off where it meets
// force, by the same actions as a gamepad.  It reads the world as an observer and never writes to it.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "autopilot/attention.h"
#include "autopilot/skill.h"
#include "core/channels.h"
#include "core/input.h"
#include "scene/scene_spec.h"
#include "task/scene_task.h"
#include "task/way.h"
#include "world/world.h"

namespace cathlab {

class Autopilot {
public:
    /// The world must be of this scene, prepared.  Throws UserError where no vessel leads to the goal.  seed: of its
    /// tremor; the same seed, scene and skill give the same inputs.
    Autopilot(const World& world, const SceneSpec& scene, const TaskSpec& task, const Skill& skill, std::uint64_t seed);

    /// What it does in the next step; call it once a step.  last: channels of the step before (of none: as they are
    /// made).
    Input act(const World& world, const Channels& last, Input base);

private:
    struct Seen {
        Channels channels;
        Vec3 middle, goal;  ///< of the goal: about which it swings, and where it was
    };
    double noisy(double value, std::uint64_t what) const;
    Vec3 believed_off(const World& world) const;
    bool draws_back(double arc_mm, Input& input);
    void go_astray(double share, Input& input);
    bool stands(double to_goal, double now_to_goal);
    double push(double to_goal, double bar) const;
    void drive_wire(const Vec3& tip, const Seen& seen, double beyond_end, Input& input);
    void drive_catheter(const Vec3& tip, const Seen& seen, Input& input);
    void steer_catheter(const World& world, const Vec3& goal, const Vec3& off, Input& input);
    void follow_with_table(const World& world, const Vec3& tip, Input& input) const;

    TaskSpec task_;
    Skill skill_;
    std::uint64_t seed_;
    double dt_;
    GoalPoint goal_;
    std::shared_ptr<const AnatomyModel> anatomy_;
    Way way_;
    Attention attention_;
    std::deque<Seen> seen_;
    std::uint64_t step_ = 0;
    // Where it is in what it does.
    Vec3 middle_ = Vec3::Zero();  // of the goal's swing
    double farthest_mm_ = 0.0, stuck_s_ = 0.0, back_mm_ = 0.0;
    double astray_s_ = 0.0, astray_mm_ = 0.0;  // how long and how far it went on in a wrong branch
    double stood_s_ = 0.0, near_enough_ = 1.0;
    // Of a wire.
    double slower_ = 1.0;  // of its speed beside the goal, after each time that it ran past
    // Of a catheter.
    double seeks_mm_ = 0.0;    // beside the goal: which way the plan wants it to go
    double nearest_mm_ = 0.0;  // that it came to the goal in this attempt
    double refused_s_ = 0.0;
    double room_ = 1.0;  // share of the skill's room that it still insists on
    Vec2 proximal_ = Vec2::Zero(), distal_ = Vec2::Zero();

    int attempts_ = 0;
    bool arrived_ = false;
    bool overshot_ = false;  // a wire
    bool near_ = false;      // a catheter
};

}  // namespace cathlab
