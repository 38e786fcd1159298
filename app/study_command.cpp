// cathlab study: a user study from its protocol to its report.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

#include "autopilot/skill.h"
#include "commands.h"
#include "core/errors.h"
#include "core/html_page.h"
#include "progress.h"
#include "record/run_files.h"
#include "record/run_reader.h"
#include "recorded_scene.h"
#include "scene/load_scene.h"
#include "scene/toml_document.h"
#include "scored_run.h"
#include "session.h"
#include "study/study_report.h"
#include "study/trial_page.h"
#include "take_poses.h"
#include "task/scene_task.h"
#include "trial_run.h"

namespace cathlab {
namespace {

namespace fs = std::filesystem;

struct StudyOptions {
    std::string folder, name, pseudonym, group, out;
    std::vector<std::string> groups{"expert", "novice"}, tasks{"a", "b", "c", "arch", "subclavian"};
    int trials = 2;
    int participants = 20;
    int threads = default_threads();
    bool verify = false;
};

[[noreturn]] void fail_without_task(const std::string& task, const std::vector<std::string>& known) {
    const std::string near = did_you_mean(task, known);
    throw UserError(
        "no task '" + task + "'" + near + (near.empty() ? "; there is: " : " There is: ") + comma_list(known), true);
}

void init(const StudyOptions& options, const AppContext& context) {
    Protocol protocol;
    protocol.name = options.name.empty() ? fs::path(options.folder).filename().string() : options.name;
    protocol.groups = options.groups;
    protocol.tasks = options.tasks;
    protocol.trials = options.trials;
    check_protocol(protocol);
    const auto known = names_in_folder(context.data_root + "/scenes/tasks", ".toml");
    for (const std::string& task : protocol.tasks)
        if (!fs::exists(task_scene(task, context))) fail_without_task(task, known);
    write_study(options.folder, protocol);
    std::printf("%s: %zu groups, %zu tasks, %d trials of each\n", options.folder.c_str(), protocol.groups.size(),
                protocol.tasks.size(), protocol.trials);
}

void add(const StudyOptions& options) {
    const Protocol protocol = read_study(options.folder);
    add_participant(options.folder, protocol, {options.pseudonym, options.group, false});
    std::printf("%s: %s takes part in group %s\n", options.folder.c_str(), options.pseudonym.c_str(),
                options.group.c_str());
}

RunIndex rebuilt_index(const std::string& folder, std::vector<std::string>& left_out) {
    RunIndex index(folder + "/index.sqlite", folder);
    left_out = index.rebuild().left_out;
    return index;
}

void status(const StudyOptions& options) {
    const Protocol protocol = read_study(options.folder);
    const auto participants = read_participants(options.folder, protocol);
    const auto trials = schedule(protocol, participants);
    std::map<std::string, int> count;
    std::map<std::string, std::string> next;
    int all = 0;
    for (const Trial& trial : trials) {
        if (trial_done(options.folder, trial)) {
            ++count[trial.participant];
            ++all;
        } else {
            next.emplace(trial.participant, "task " + trial.task + ", trial " + std::to_string(trial.trial));
        }
    }
    std::vector<std::string> left_out;
    rebuilt_index(options.folder, left_out);
    std::printf("%s: %d of %zu trials are done\n", options.folder.c_str(), all, trials.size());
    for (const Participant& p : participants)
        std::printf("  %-32s %-16s %3d done   %s%s\n", p.pseudonym.c_str(), p.group.c_str(), count[p.pseudonym],
                    next.contains(p.pseudonym) ? ("next: " + next[p.pseudonym]).c_str() : "finished",
                    p.synthetic ? "   (synthetic)" : "");
    for (const std::string& sentence : left_out) std::printf("  left out: %s\n", sentence.c_str());
}

/// Does all of them, so many at the same time, until one throws or a stop is wanted; how many said that they are done.
std::size_t each_at_once(const char* job, std::size_t count, int threads,
                         const std::function<bool(std::size_t)>& work_on) {
    catch_stop_signals();
    Progress progress(job);
    std::atomic<std::size_t> next{0}, finished{0};
    std::mutex mutex;
    std::exception_ptr failure;
    const auto work = [&] {
        for (std::size_t k = next++; k < count && !stop_wanted(); k = next++) {
            try {
                if (work_on(k)) ++finished;
            } catch (...) {
                const std::scoped_lock lock(mutex);
                if (!failure) failure = std::current_exception();
                next = count;
            }
            const std::scoped_lock lock(mutex);
            progress.update(static_cast<double>(finished) / static_cast<double>(count),
                            std::to_string(finished) + " of " + std::to_string(count) + " trials");
        }
    };
    std::vector<std::jthread> workers;
    for (int k = 1; k < threads; ++k) workers.emplace_back(work);
    work();
    workers.clear();
    progress.end();
    if (failure) std::rethrow_exception(failure);
    return finished;
}

void rehearse(const StudyOptions& options, AppContext& context) {
    const Protocol protocol = read_study(options.folder);
    for (const std::string& group : protocol.groups) find_skill(group);
    for (int k = static_cast<int>(read_participants(options.folder, protocol).size()); k < options.participants; ++k) {
        char name[16];
        std::snprintf(name, sizeof name, "S%02d", k + 1);
        add_participant(options.folder, protocol,
                        {name, protocol.groups[static_cast<std::size_t>(k) % protocol.groups.size()], true});
    }
    std::vector<Trial> open;
    for (const Trial& trial : schedule(protocol, read_participants(options.folder, protocol)))
        if (trial.synthetic && !trial_done(options.folder, trial)) open.push_back(trial);
    std::map<std::string, std::pair<SceneSpec, std::shared_ptr<const SceneModels>>> scenes;
    for (const Trial& trial : open) {
        if (scenes.contains(trial.task)) continue;
        const SceneSpec scene = load_scene(task_scene(trial.task, context), {}, context.data_root);
        scenes[trial.task] = {scene, session_models(scene, options.threads, context)};
    }
    const std::size_t finished = each_at_once("rehearsing", open.size(), options.threads, [&](std::size_t k) {
        const auto& [scene, models] = scenes.at(open[k].task);
        return fly(
            {options.folder + "/" + open[k].folder, open[k].group, trial_seed(protocol, open[k]), trial_json(open[k])},
            scene, *models, context);
    });
    std::printf("%s: %zu trials by autopilots, %zu were there before or are left\n", options.folder.c_str(), finished,
                open.size() - finished);
    if (finished < open.size()) context.exit_code = 1;
}

/// Of the runs that count: the last trial of each task.
std::vector<GroupForces> forces_of(const std::string& study, const Protocol& protocol,
                                   const std::vector<RunEntry>& runs) {
    std::vector<GroupForces> out;
    for (const std::string& group : protocol.groups) {
        GroupForces sum{group, 0, {}};
        for (const RunEntry& run : runs) {
            const std::string path = study + "/" + run.folder + "/force-map.csv";
            if (run.group != group || run.trial != protocol.trials || !fs::exists(path)) continue;
            sum.forces.add(parse_force_map(read_text_file(path, 1U << 24U), path));
            ++sum.runs;
        }
        out.push_back(std::move(sum));
    }
    return out;
}

/// Of all runs; a sheet that cannot be read is left out and said.
std::vector<GroupAnswers> answers_of(const std::string& study, const Protocol& protocol,
                                     const std::vector<RunEntry>& runs, std::vector<std::string>& left_out) {
    std::vector<GroupAnswers> out;
    for (const std::string& group : protocol.groups) {
        GroupAnswers answers{group, {}};
        for (const RunEntry& run : runs) {
            const std::string path = study + "/" + run.folder + "/questionnaire.json";
            if (run.group != group || !fs::exists(path)) continue;
            try {
                answers.sheets.push_back(read_questionnaire(path));
            } catch (const UserError& error) {
                left_out.emplace_back(error.what());
            }
        }
        out.push_back(std::move(answers));
    }
    return out;
}

/// Where the trial can be watched, and whether it is what its inputs give.
class TrialNotes {
public:
    TrialNotes(const StudyOptions& options, const std::string& out, const AppContext& context)
        : options_(options), out_(out), context_(context) {}

    /// Writes the trial's page.  What differs is said in the note, what hinders the reading in `left_out` too; throws
    /// UserError where the page cannot be written or a stop was wanted.
    TrialNote make(const RunEntry& run, std::string& left_out) {
        TrialNote note;
        std::string page;
        try {
            const RunRecord record = read_run(options_.folder + "/" + run.folder);
            const SceneSpec scene = recorded_scene(record, context_);
            const auto models = models_of(scene);
            std::vector<TrialFrame> frames = frames_of(record, scene);
            double device_mm = 1.0;
            if (options_.verify) note.verified = verify(record, scene, *models, frames, device_mm);
            note.page = "trials/" + run.participant + "-" + run.task + "-" + std::to_string(run.trial) + ".html";
            const std::string verified = note.verified == "yes"  ? "verified: its inputs give the same run"
                                         : note.verified.empty() ? ""
                                                                 : "NOT VERIFIED: " + note.verified;
            page = trial_page(run, anatomy_of(*models).centreline, frames, device_mm, verified, "../report.html");
        } catch (const UserError& error) {
            if (stop_wanted()) throw;
            left_out = std::string("a trial's page: ") + error.what();
            if (options_.verify) note.verified = error.what();
            return note;
        }
        write_whole_file(out_ + "/" + note.page, page);
        return note;
    }

private:
    static constexpr std::size_t steps_a_frame = 5;
    static constexpr double line_mm = 150.0, line_step_mm = 4.0;  // of a device that a page shows

    std::shared_ptr<const SceneModels> models_of(const SceneSpec& scene) {
        const std::scoped_lock lock(mutex_);
        std::string key = scene.path;
        for (const std::string& overlay : scene.overlays) key += "\n" + overlay;
        auto& models = models_[key];
        if (!models) models = session_models(scene, options_.threads, context_);
        return models;
    }

    static bool about_catheter(const SceneSpec& scene) {
        const auto task = task_of(scene);
        return task && task->device == "catheter";
    }

    /// The run that is stepped again shows where the device lay, which no file of a trial does; and how thick it is.
    static std::vector<Vec3> line_of(World& world, const std::string& device, double& device_mm) {
        ScenePoses poses;
        take_poses(world, poses);
        std::vector<Vec3> out;
        for (const DevicePose& pose : poses.devices) {
            if (pose.name != device || pose.points.empty()) continue;
            if (!pose.radius_mm.empty()) device_mm = 2.0 * pose.radius_mm.front();
            // A wire's points go from its tip back, a catheter's to its tip.
            std::vector<Vec3> points = pose.points;
            if (device == "catheter") std::reverse(points.begin(), points.end());
            double since = line_step_mm, all = 0.0;
            for (std::size_t i = 0; i < points.size() && all < line_mm; ++i) {
                const double d = i == 0 ? 0.0 : std::sqrt((points[i] - points[i - 1]).squaredNorm());
                since += d;
                all += d;
                if (since < line_step_mm) continue;
                out.push_back(points[i]);
                since = 0.0;
            }
        }
        return out;
    }

    std::string verify(const RunRecord& record, const SceneSpec& scene, const SceneModels& models,
                       std::vector<TrialFrame>& frames, double& device_mm) const {
        const std::string device = about_catheter(scene) ? "catheter" : "wire";
        const auto keep = [&](std::int64_t step, World& world) {
            const auto k = static_cast<std::size_t>(step);
            if (k % steps_a_frame == 0 && k / steps_a_frame < frames.size())
                frames[k / steps_a_frame].device = line_of(world, device, device_mm);
        };
        const ScoredRun scored = score_run(record, scene, &models, 1, context_, {}, keep);
        return scored.differences.empty() ? "yes" : scored.differences.front();
    }

    static std::vector<TrialFrame> frames_of(const RunRecord& record, const SceneSpec& scene) {
        const bool catheter = about_catheter(scene);
        const std::vector<Channels> trace = read_trace(record.folder, record.manifest.complete);
        std::vector<TrialFrame> frames;
        for (std::size_t k = 0; k < trace.size(); k += steps_a_frame) {
            const Channels& c = trace[k];
            frames.push_back({c.time_s,
                              catheter ? Vec3(c.catheter_tip_x_mm, c.catheter_tip_y_mm, c.catheter_tip_z_mm)
                                       : Vec3(c.wire_tip_x_mm, c.wire_tip_y_mm, c.wire_tip_z_mm),
                              c.force_bar,
                              c.beam_on > 0.5,
                              c.primary_angle_deg,
                              c.secondary_angle_deg,
                              {}});
        }
        return frames;
    }

    const StudyOptions& options_;
    std::string out_;
    const AppContext& context_;
    std::mutex mutex_;
    std::map<std::string, std::shared_ptr<const SceneModels>> models_;  // by the scene and its overlays
};

void make_folder(const std::string& path) {
    std::error_code error;
    fs::create_directories(path, error);
    if (error) throw UserError(path + ": cannot be made: " + error.message(), true);
}

void report(const StudyOptions& options, AppContext& context) {
    const Protocol protocol = read_study(options.folder);
    const auto participants = read_participants(options.folder, protocol);
    std::vector<std::string> left_out;
    const RunIndex index = rebuilt_index(options.folder, left_out);
    std::vector<RunEntry> runs;
    for (RunEntry& run : index.list())
        if (run.trial > 0) runs.push_back(std::move(run));
    const std::string out = options.out.empty() ? options.folder : options.out;
    make_folder(out + "/trials");
    TrialNotes made(options, out, context);
    std::vector<TrialNote> note(runs.size());
    std::vector<std::string> pageless(runs.size());
    each_at_once(options.verify ? "verifying" : "drawing", runs.size(), options.threads, [&](std::size_t k) {
        note[k] = made.make(runs[k], pageless[k]);
        return true;
    });
    if (stop_wanted()) throw UserError("stopped; no report was written");
    std::map<std::string, TrialNote> notes;
    for (std::size_t k = 0; k < runs.size(); ++k) {
        if (options.verify && note[k].verified != "yes") {
            std::printf("DIFFERS: %s: %s\n", runs[k].folder.c_str(), note[k].verified.c_str());
            context.exit_code = 1;
        }
        if (!pageless[k].empty()) left_out.push_back(std::move(pageless[k]));
        notes[runs[k].folder] = std::move(note[k]);
    }
    Page page = study_page(protocol, participants, runs, notes);
    const auto answers = answers_of(options.folder, protocol, runs, left_out);
    page.bars = likert_bars(answers);
    if (PageTable scales = scales_table(answers); !scales.rows.empty()) page.tables.push_back(std::move(scales));
    page.maps = force_maps(forces_of(options.folder, protocol, runs));
    for (const std::string& sentence : left_out) page.paragraphs.push_back("Left out: " + sentence);
    page.command = context.command_line;
    write_whole_file(out + "/report.html", html_page(page));
    write_whole_file(out + "/trials.csv", trials_csv(runs));
    std::printf("written: %s/report.html, %s/trials.csv, %s/trials (%zu runs)\n", out.c_str(), out.c_str(), out.c_str(),
                runs.size());
}

}  // namespace

void add_study_command(CLI::App& app, AppContext& context) {
    const auto options = std::make_shared<StudyOptions>();
    CLI::App* study = app.add_subcommand("study", "A user study: its folder, who takes part, rehearsal and report");
    study->require_subcommand(1);
    const auto sub = [&](const char* name, const char* text) {
        CLI::App* command = study->add_subcommand(name, text);
        command->add_option("STUDY", options->folder, "the study's folder")->required();
        return command;
    };
    CLI::App* made = sub("init", "Make a study folder with its protocol");
    made->add_option("--name", options->name, "else the folder's");
    made->add_option("--groups", options->groups, "names")->delimiter(',')->capture_default_str();
    made->add_option("--tasks", options->tasks, "names of scenes/tasks")->delimiter(',')->capture_default_str();
    made->add_option("--trials", options->trials, "of each task; the last one counts")->capture_default_str();
    made->callback([options, &context] { init(*options, context); });
    CLI::App* added = sub("add", "One who takes part, by pseudonym");
    added->add_option("PSEUDONYM", options->pseudonym, "letters, digits, '-' and '_'")->required();
    added->add_option("--group", options->group, "one of the study's")->required();
    added->callback([options] { add(*options); });
    sub("status", "What is done and what comes next")->callback([options] { status(*options); });
    CLI::App* rehearsed =
        sub("rehearse", "Fill the study with synthetic participants: autopilots whose skill is their group's name");
    rehearsed->add_option("--participants", options->participants, "in all")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    const auto threads = [options](CLI::App* command) {
        command->add_option("--threads", options->threads, "trials at the same time")
            ->check(CLI::Range(1, 256))
            ->capture_default_str();
    };
    threads(rehearsed);
    rehearsed->callback([options, &context] { rehearse(*options, context); });
    CLI::App* reported = sub("report", "One page, a page for each trial and a table from the run folders");
    reported->add_flag("--verify", options->verify,
                       "steps every trial again from its inputs; exit code 1 where anything differs");
    threads(reported);
    reported->add_option("--out", options->out, "a folder; else the study's own");
    reported->callback([options, &context] { report(*options, context); });
}

}  // namespace cathlab
