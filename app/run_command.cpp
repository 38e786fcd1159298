// cathlab run: a scene and a script -> a run folder.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "autopilot/autopilot.h"
#include "commands.h"
#include "core/log.h"
#include "film.h"
#include "progress.h"
#include "record/poses.h"
#include "record/run_writer.h"
#include "record/sums.h"
#include "run_facts.h"
#include "run_options.h"
#include "scene/load_scene.h"
#include "scene/script.h"
#include "session.h"
#include "task_watch.h"

namespace cathlab {
namespace {

struct RunOptions {
    std::string scene, out, script;
    std::vector<std::string> overlays;
    double seconds = 0.0;
    std::optional<std::uint64_t> seed;
    int threads = default_threads();
    FilmArguments film;
    double poses_hz = -1.0;  // < 0: as the film's pictures, none without one
    bool force = false;
    std::string pilot;  // "" = the script
    std::string skill = "expert";
};

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

// The run itself: everything that must be closed in order when it ends, however it ends.
class Recording {
public:
    Recording(const RunOptions& options, Session& session, const Script& script, const AppContext& context)
        : session_(session),
          script_(script),
          folder_(options.out),
          steps_(step_count(options, session)),
          watch_(session.world(), task_of(session.scene())),
          pilot_(pilot(options, session)),
          who_{pilot_ ? options.pilot : "script", pilot_ ? options.skill : ""},
          film_(open_film(options, session)),
          writer_(folder_, manifest(options, session, context), session.entity_names()),
          poses_(open_poses(options, session)) {}

    /// True if the run reached its end, false if it was stopped.  After an exception the folder is closed too.
    bool run() {
        try {
            loop();
        } catch (...) {
            try {
                finish(false);
            } catch (const std::exception& second) {
                log::error(std::string("closing the run folder: ") + second.what());
            }
            throw;
        }
        const bool complete = done_ == steps_ || watch_.over();
        finish(complete);
        return complete;
    }
    const TaskWatch& watch() const { return watch_; }
    double simulated_s() const { return static_cast<double>(done_) * session_.dt(); }
    double wall_s() const { return wall_s_; }
    const std::string& video() const { return video_; }

private:
    static std::unique_ptr<Autopilot> pilot(const RunOptions& options, Session& session) {
        if (options.pilot.empty()) return nullptr;
        const auto task = task_of(session.scene());
        if (!task)
            throw UserError(session.scene().path + ": sets no [task], so an autopilot has nothing to do there", true);
        return std::make_unique<Autopilot>(session.world(), session.scene(), *task, find_skill(options.skill),
                                           session.world().seed());
    }
    static std::int64_t step_count(const RunOptions& options, const Session& session) {
        const double seconds = options.seconds > 0.0 ? options.seconds : session.scene().duration_s;
        return std::max<std::int64_t>(1, std::llround(seconds / session.dt()));
    }
    // The film comes before the logs: where it cannot be made, no half run is left behind.
    std::unique_ptr<Film> open_film(const RunOptions& options, const Session& session) {
        prepare_run_folder(folder_, options.force);
        if (!filmed(options.film)) return nullptr;
        video_ = options.film.video.empty() ? folder_ + "/fluoro.mp4" : options.film.video;
        if (video_ == "none") video_.clear();
        try {
            return std::make_unique<Film>(session.scene(), film_options(options.film, session.scene(), video_, folder_),
                                          share_threads(options.threads, true).film);
        } catch (...) {
            std::error_code not_empty;
            std::filesystem::remove(folder_, not_empty);
            throw;
        }
    }
    std::unique_ptr<PosesWriter> open_poses(const RunOptions& options, Session& session) const {
        const double film_hz = film_ ? film_options(options.film, session.scene(), "", "").fps : 0.0;
        const double rate_hz = options.poses_hz >= 0.0 ? options.poses_hz : film_hz;
        if (rate_hz <= 0.0) return nullptr;
        return std::make_unique<PosesWriter>(folder_, poses_frame(*stage_of(session.world()).anatomy), rate_hz);
    }
    static RunManifest manifest(const RunOptions& options, Session& session, const AppContext& context) {
        RunManifest m = manifest_of(session.scene(), options.overlays, session.anatomy_hash(), context);
        if (!options.script.empty()) m.script = path_for_manifest(options.script, context.data_root);
        m.seed = session.world().seed();
        m.threads = options.threads;
        return m;
    }

    void loop() {
        begin_ = Clock::now();
        Progress progress("running");
        const Input base = session_.base_input();
        for (; done_ < steps_ && !watch_.over() && !stop_wanted(); ++done_) {
            if (RunWriter::wants_hash(done_)) writer_.hash(done_, session_.world().state_hash());
            const Input input = pilot_ ? pilot_->act(session_.world(), session_.channels(), base)
                                       : script_.at(static_cast<double>(done_) * session_.dt(), base);
            writer_.input(done_, input);
            session_.step(input);
            writer_.step(done_, session_.channels(), session_.events());
            watch_.add(session_.world(), session_.channels(), session_.dt());
            if (poses_) keep_poses();
            if (film_) draw();
            char detail[64];
            std::snprintf(detail, sizeof detail, "%.1f of %.1f s", simulated_s(),
                          static_cast<double>(steps_) * session_.dt());
            progress.update(static_cast<double>(done_ + 1) / static_cast<double>(steps_), detail);
        }
    }
    void keep_poses() {
        if (poses_->due(session_.channels().time_s)) {
            take_poses(session_.world(), moving_);
            poses_->add(done_, moving_);
        }
        if (RunWriter::flushes(done_)) poses_->flush();
    }
    void draw() {
        for (const Event& event : session_.events()) film_->message(event);
        while (film_->due(session_.channels().time_s)) film_->add(session_.world(), session_.channels());
        // The poster comes from the later part of a run, where the devices have arrived.
        if (done_ * 4 == steps_ * 3) film_->keep_poster();
    }
    void finish(bool complete) {
        if (finished_) return;
        finished_ = true;
        if (done_ > 0) writer_.hash(done_, session_.world().state_hash());
        if (poses_) poses_->close();
        if (!watch_.empty()) {
            writer_.file("metrics.json", metrics_json(watch_.metrics()));
            writer_.file("regions.csv", watch_.forces().regions_csv());
            writer_.file("force-map.csv", force_map_csv(watch_.forces().unrolled()));
        }
        if (watch_.task()) writer_.file("result.json", watch_.result_json(who_));
        std::exception_ptr film_failure;  // a film that cannot be finished must not leave the logs open
        try {
            finish_film();
        } catch (...) {
            film_failure = std::current_exception();
            video_.clear();
        }
        wall_s_ = seconds_since(begin_);
        const std::filesystem::path video(video_);
        const bool inside = video.parent_path() == std::filesystem::path(folder_);
        writer_.finish(done_, complete && !film_failure, wall_s_, inside ? video.filename().string() : video_);
        write_sums(folder_);
        if (film_failure) std::rethrow_exception(film_failure);
    }
    void finish_film() {
        if (!film_ || film_->failed() || film_->frames() == 0) {
            video_.clear();
            return;
        }
        write_png(folder_ + "/poster.png", film_->poster());
        film_->close();
    }

    Session& session_;
    const Script& script_;
    std::string folder_;
    std::int64_t steps_ = 0;
    std::int64_t done_ = 0;
    std::string video_;
    TaskWatch watch_;
    std::unique_ptr<Autopilot> pilot_;
    OperatorName who_;
    std::unique_ptr<Film> film_;
    RunWriter writer_;
    std::unique_ptr<PosesWriter> poses_;
    ScenePoses moving_;
    Clock::time_point begin_ = Clock::now();
    double wall_s_ = 0.0;
    bool finished_ = false;
};

void run(RunOptions options, AppContext& context) {
    require_finite("--seconds", options.seconds);
    require_finite("--poses", options.poses_hz);
    const SceneSpec scene =
        load_scene(find_scene(options.scene, context.data_root), options.overlays, context.data_root);
    if (!options.pilot.empty() && !options.script.empty())
        throw UserError("--script and --operator exclude each other", true);
    if (!options.pilot.empty()) find_skill(options.skill);
    if (options.script.empty() && options.pilot.empty()) options.script = scene.script;
    const Script script = options.script.empty() ? Script() : Script::load(options.script);
    film_options(options.film, scene, "", "");  // a wrong size is told before the world is built
    check_run_folder(options.out, options.force);
    Session session(scene, options.seed.value_or(scene.seed), share_threads(options.threads, filmed(options.film)).step,
                    context);
    Recording recording(options, session, script, context);
    const bool complete = recording.run();
    const double simulated = recording.simulated_s();
    std::printf("%s: %.2f s simulated in %.2f s (%.2f x real time)%s%s\n", options.out.c_str(), simulated,
                recording.wall_s(), simulated / std::max(1e-9, recording.wall_s()),
                recording.video().empty() ? "" : ", film ", recording.video().c_str());
    if (const auto& task = recording.watch().task())
        std::printf("task %s: %s, score %.1f of 100 (%.0f passes)\n", task->name.c_str(),
                    recording.watch().reached() ? "reached" : "not reached", recording.watch().score(),
                    task->pass_score);
    if (!complete) {
        context.exit_code = 1;
        std::fprintf(stderr, "cathlab: stopped after %.2f s; %s is closed and marked incomplete\n", simulated,
                     options.out.c_str());
    }
}

}  // namespace

void add_run_command(CLI::App& app, AppContext& context) {
    const auto options = std::make_shared<RunOptions>();
    CLI::App* command = app.add_subcommand("run", "Run a scene and write a run folder");
    command->add_option("SCENE", options->scene, "a scene file, or the name of one in scenes/")->required();
    command->add_option("--out", options->out, "the run folder: new, empty, or with --force an earlier run's")
        ->required();
    command->add_option("--script", options->script, "what the operator does: CSV t_s,action,value; else the scene's");
    command->add_option("--seconds", options->seconds, "simulated time; else the scene's duration_s")
        ->check(CLI::Range(0.001, 86400.0));
    command->add_option("--seed", options->seed, "of every random number; else the scene's")
        ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{9007199254740991}));
    command->add_option("--threads", options->threads, "in all; from 2 on one of them draws the film")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    add_film_options(*command, options->film,
                     "the film: .mp4, .avi (lossless), or none; else fluoro.mp4 in the folder");
    command
        ->add_option(
            "--poses", options->poses_hz,
            "how often a second poses.bin keeps what moves, for `cathlab render`; 0: never; else as the film's "
            "pictures, and never without a film")
        ->check(CLI::Range(0.0, 1000.0));
    command->add_option("--overlay", options->overlays, "a file laid over the scene; may be given again")
        ->allow_extra_args(false);
    command->add_option("--operator", options->pilot, "who acts instead of a script; the scene must set a task")
        ->check(CLI::IsMember({"autopilot"}));
    command->add_option("--skill", options->skill, "of the autopilot: expert, intermediate or novice")
        ->capture_default_str();
    command->add_flag("--force", options->force, "replace an earlier run in the folder");
    command->callback([options, &context] { run(*options, context); });
}

}  // namespace cathlab
