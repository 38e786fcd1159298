// A session of the trainer without its window: the world, the hands' pilot, the recording, the task.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "context.h"
#include "describe_frame.h"
#include "hud/hud_data.h"
#include "message_lines.h"
#include "play/pilot.h"
#include "play/recorder.h"
#include "record/run_reader.h"
#include "scene/build_world.h"
#include "session.h"
#include "task_watch.h"

namespace cathlab::play {

struct SimulationOptions {
    SceneSpec scene;
    std::optional<TaskSpec> task;
    std::optional<RecorderOptions> recorder;  ///< nothing = not recorded
    std::optional<RunRecord> replay;          ///< nothing = played by hand
    int threads = 1;
};

/// What the goal looks like now.
struct GoalView {
    bool present = false;
    Vec3 position = Vec3::Zero();
    double radius_mm = 0.0, distance_mm = 0.0, held_s = 0.0, hold_s = 0.0, left_s = 0.0;
    bool inside = false;
    GoalTracker::Outcome outcome = GoalTracker::Outcome::open;
};

/// For the result's plots.
struct Course {
    std::vector<float> force_bar;  ///< one a step; 1 = the limit
    std::vector<Vec3> tip;         ///< wherever it has moved on by onward_mm
    double onward_mm = 0.5;        ///< grows with the way, so that its memory does not

    /// wire: whose tip goes on the path.
    void add(const Channels& c, bool wire);
};

class Simulation {
public:
    /// Throws UserError.  A recording that cannot be begun is said in recording_fault() and the session goes on.
    Simulation(SimulationOptions options, std::shared_ptr<const SceneModels> models, const AppContext& context);
    ~Simulation();

    /// One step under the hands' command, or the next of the replay.
    void step(const Controls& controls, const InputSettings& settings);
    /// Whether the task, or the replay, has come to its end.
    bool over() const;

    Pilot& pilot() { return pilot_; }
    const Pilot& pilot() const { return pilot_; }
    Session& session() { return session_; }
    const Channels& channels() const { return session_.channels(); }
    const Input& input() const { return input_; }
    std::int64_t steps() const { return steps_; }
    std::int64_t replay_steps() const { return options_.replay ? options_.replay->steps : 0; }
    double dt() const { return session_.dt(); }
    const SceneSpec& scene() const { return options_.scene; }
    /// What may build the same world again.
    const std::shared_ptr<const SceneModels>& models() const { return models_; }
    /// The middle of the vessels, as lines.
    std::vector<std::vector<Vec3>> vessels();
    const GoalView& goal() const { return goal_; }
    const Course& course() const { return course_; }
    const TaskWatch& watch() const { return watch_; }
    Metrics metrics() const { return watch_.metrics(); }
    std::optional<double> score() const;
    /// X-ray pulses so far: a new fluoroscopy is due with each.
    std::uint64_t pulses() const { return pulses_; }

    /// Fills everything but sizes and overlay, as Film does.
    void describe(FrameDescription& frame);
    /// What colours the wall in the view from outside.
    void set_outer_map(OuterMap map) { outer_map_ = map; }
    /// Everything but frames a second and the real-time factor.
    void fill_panels(HudData& out);

    void flush();
    /// Closes the recording.  Once; the destructor does it as incomplete.
    void finish(bool complete);
    std::string folder() const { return recorder_ ? recorder_->folder() : ""; }
    std::string recording_fault() const { return recorder_ ? recorder_->fault() : fault_; }
    Recorder* recorder() { return recorder_ ? &*recorder_ : nullptr; }

private:
    void follow_goal();

    SimulationOptions options_;
    std::shared_ptr<const SceneModels> models_;
    Session session_;
    Pilot pilot_;
    std::optional<Recorder> recorder_;
    std::string fault_;
    TaskWatch watch_;
    GoalView goal_;
    Course course_;
    MessageLines messages_;
    FrameMemory memory_;
    ScenePoses poses_;
    std::optional<FrameCamera> camera_;
    OuterMap outer_map_ = OuterMap::displacement;
    Input input_;
    std::int64_t steps_ = 0;
    std::uint64_t pulses_ = 0;
    bool finished_ = false;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();  // for the manifest alone
};

}  // namespace cathlab::play
