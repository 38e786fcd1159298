// The trainer's end of a session: its result, the expert beside it, a study's trial with its questions.
#include <filesystem>

#include "core/errors.h"
#include "core/log.h"
#include "play/earlier_trials.h"
#include "play/play_app.h"
#include "record/run_files.h"
#include "record/sums.h"

namespace cathlab::play {
namespace fs = std::filesystem;

void PlayApp::make_result(Simulation& simulation, bool reached) {
    result_ = {};
    result_.metrics = simulation.metrics();
    result_.course = simulation.course();
    result_.dt = simulation.dt();
    result_.folder = simulation.recording_fault().empty() ? simulation.folder() : "";
    result_.title = "Free play";
    if (!asked_.task.empty()) result_.title = simulation.scene().title;
    result_.vessels = simulation.vessels();
    result_.trial = desk_.has_value();
    flown_scene_ = simulation.scene();
    flown_models_ = simulation.models();
    result_.score = simulation.score();
    if (asked_.task.empty())
        result_.outcome = "Ended.";
    else if (reached)
        result_.outcome = "Reached.";
    else
        result_.outcome = simulation.goal().outcome == GoalTracker::Outcome::out_of_time ? "The time is over."
                                                                                         : "Ended before the goal.";
    if (!asked_.task.empty() && !result_.folder.empty()) {
        const auto looked = [&](Side side) { return looked_s_[static_cast<std::size_t>(side)]; };
        OperatorName who{"person", "", difficulty_name(asked_.difficulty), {}};
        who.aids_s = {{"inner_view_s", looked(Side::inner)},
                      {"displacement_view_s", looked(Side::displacement)},
                      {"force_view_s", looked(Side::force)}};
        if (Recorder* recorder = simulation.recorder())
            recorder->file("result.json", simulation.watch().result_json(who));
        result_.earlier = earlier_trials(fs::path(result_.folder).parent_path().string(), asked_.task, result_.folder);
    }
}

// A trial that is not whole on the disk is none: it comes again.
void PlayApp::keep_trial(bool recorded) {
    try {
        if (!recorded) throw UserError("it could not be recorded");
        result_.folder = desk_->keep();
    } catch (const UserError& error) {
        log::error(error.what());
        result_.outcome += " This trial does not count: " + std::string(error.what());
        result_.folder.clear();
    }
    questions_ = {};
}

void PlayApp::keep_answers() {
    questions_.changed = false;
    if (result_.folder.empty()) return;
    try {
        write_whole_file(result_.folder + "/questionnaire.json", questionnaire_json(questions_.answers));
        write_sums(result_.folder);
    } catch (const UserError& error) {
        say(error.what());
    }
}

void PlayApp::to_study() {
    screen_ = Screen::study;
    setup_ = {};
    if (!desk_->next()) return;
    study_task_ = desk_->task();
    choose_task(study_task_, setup_);
    setup_.difficulty = Difficulty::standard;
}

std::string PlayApp::experts_home() const {
    return data_home().empty() ? "" : data_home() + "/experts";
}

void PlayApp::look_for_expert() {
    if (experts_home().empty() || desk_) return;  // a trial is not told what others do
    result_.expert = Expert::find(flown_scene_, experts_home());
    result_.expert_wanted = !result_.expert;
}

Paused PlayApp::paused_what() const {
    if (!options_.replay.empty()) return Paused::replay;
    return desk_ ? Paused::trial : Paused::session;
}

StudyView PlayApp::study_view() const {
    StudyView out;
    out.participant = desk_->participant();
    out.done = desk_->done();
    out.total = desk_->total();
    if (desk_->next()) {
        out.title = study_task_.title;
        out.instructions = study_task_.task.instructions;
    }
    return out;
}

}  // namespace cathlab::play
