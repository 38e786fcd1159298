// cathlab study: a user study from its protocol to its report.
#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <thread>

#include "autopilot/skill.h"
#include "commands.h"
#include "core/errors.h"
#include "core/html_page.h"
#include "progress.h"
#include "record/run_files.h"
#include "scene/load_scene.h"
#include "scene/toml_document.h"
#include "session.h"
#include "study/study_report.h"
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
};

void init(const StudyOptions& options, const AppContext& context) {
    Protocol protocol;
    protocol.name = options.name.empty() ? fs::path(options.folder).filename().string() : options.name;
    protocol.groups = options.groups;
    protocol.tasks = options.tasks;
    protocol.trials = options.trials;
    check_protocol(protocol);
    const auto known = names_in_folder(context.data_root + "/scenes/tasks", ".toml");
    for (const std::string& task : protocol.tasks)
        if (!fs::exists(task_scene(task, context)))
            throw UserError("no task '" + task + "'" + did_you_mean(task, known) + " There is: " + comma_list(known),
                            true);
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
    catch_stop_signals();
    Progress progress("rehearsing");
    std::atomic<std::size_t> next{0}, finished{0};
    std::mutex mutex;
    std::exception_ptr failure;
    const auto work = [&] {
        for (std::size_t k = next++; k < open.size() && !stop_wanted(); k = next++) {
            try {
                const auto& [scene, models] = scenes.at(open[k].task);
                const PilotedRun run{options.folder + "/" + open[k].folder, open[k].group,
                                     trial_seed(protocol, open[k]), trial_json(open[k])};
                if (fly(run, scene, *models, context)) ++finished;
            } catch (...) {
                const std::scoped_lock lock(mutex);
                if (!failure) failure = std::current_exception();
                next = open.size();
            }
            const std::scoped_lock lock(mutex);
            progress.update(static_cast<double>(finished) / static_cast<double>(open.size()),
                            std::to_string(finished) + " of " + std::to_string(open.size()) + " trials");
        }
    };
    std::vector<std::jthread> threads;
    for (int k = 1; k < options.threads; ++k) threads.emplace_back(work);
    work();
    threads.clear();
    progress.end();
    if (failure) std::rethrow_exception(failure);
    std::printf("%s: %zu trials by autopilots, %zu were there before or are left\n", options.folder.c_str(),
                finished.load(), open.size() - finished.load());
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

void report(const StudyOptions& options, const AppContext& context) {
    const Protocol protocol = read_study(options.folder);
    const auto participants = read_participants(options.folder, protocol);
    std::vector<std::string> left_out;
    const RunIndex index = rebuilt_index(options.folder, left_out);
    std::vector<RunEntry> runs;
    for (RunEntry& run : index.list())
        if (run.trial > 0) runs.push_back(std::move(run));
    Page page = study_page(protocol, participants, runs);
    const auto answers = answers_of(options.folder, protocol, runs, left_out);
    page.bars = likert_bars(answers);
    if (PageTable scales = scales_table(answers); !scales.rows.empty()) page.tables.push_back(std::move(scales));
    page.maps = force_maps(forces_of(options.folder, protocol, runs));
    for (const std::string& sentence : left_out) page.paragraphs.push_back("Left out: " + sentence);
    page.command = context.command_line;
    const std::string out = options.out.empty() ? options.folder : options.out;
    std::error_code error;
    fs::create_directories(out, error);
    if (error) throw UserError(out + ": cannot be made: " + error.message(), true);
    write_whole_file(out + "/report.html", html_page(page));
    write_whole_file(out + "/trials.csv", trials_csv(runs));
    std::printf("written: %s/report.html, %s/trials.csv (%zu runs)\n", out.c_str(), out.c_str(), runs.size());
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
    rehearsed->add_option("--threads", options->threads, "trials at the same time")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    rehearsed->callback([options, &context] { rehearse(*options, context); });
    CLI::App* reported = sub("report", "One page and a table from the run folders");
    reported->add_option("--out", options->out, "a folder; else the study's own");
    reported->callback([options, &context] { report(*options, context); });
}

}  // namespace cathlab
