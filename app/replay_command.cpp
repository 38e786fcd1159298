// cathlab replay: a run again from step 0 with its recorded inputs, compared with what was recorded.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "beam/view_presets.h"
#include "commands.h"
#include "core/errors.h"
#include "core/log.h"
#include "film.h"
#include "progress.h"
#include "record/poses.h"
#include "record/run_reader.h"
#include "record/run_writer.h"
#include "recorded_film.h"
#include "recorded_scene.h"
#include "run_options.h"
#include "run_verifier.h"
#include "session.h"

namespace cathlab {
namespace {

struct ReplayOptions {
    std::string folder;
    bool verify = false;
    int threads = default_threads();
    FilmArguments film;
    std::string out;    // folder of what is made of the pictures
    std::string still;  // "" or a file: the last picture
    double to_s = 0.0;  // 0: to the run's end
    bool simulate = false;
};

bool pictured(const ReplayOptions& options) {
    const FilmArguments& film = options.film;
    return (!film.video.empty() && film.video != "none") || !film.labels.empty() || !film.dicom.empty() ||
           !film.frames.empty() || !options.still.empty();
}

// What the film says of its pictures as it is closed.
struct Exposed {
    std::size_t pictures = 0, open = 0;
};

std::unique_ptr<Film> open_film(const ReplayOptions& options, const SceneSpec& scene, int threads, Exposed& exposed,
                                int draw_threads = 1) {
    const std::string video = options.film.video == "none" ? "" : options.film.video;
    FilmOptions film = film_options(options.film, scene, video, options.out);
    film.draw_threads = draw_threads;
    film.at_close = [&exposed](std::size_t pictures, std::size_t open) { exposed = {pictures, open}; };
    return std::make_unique<Film>(scene, film, threads);
}

std::int64_t end_of(const ReplayOptions& options, std::int64_t steps, double dt_s) {
    return options.to_s > 0.0 ? std::min<std::int64_t>(steps, std::llround(options.to_s / dt_s)) : steps;
}

void close_film(const ReplayOptions& options, Film& film) {
    if (!options.still.empty() && film.frames() > 0) write_png(options.still, film.poster());
    film.close();
}

// What the run left of itself is enough for a picture.
void render_poses(const ReplayOptions& options, const RunRecord& run, AppContext& context) {
    const SceneSpec scene = recorded_scene(run, context);
    const ThreadShares threads = share_threads(options.threads, true);
    const FilmOptions wanted = film_options(options.film, scene, "", options.out);
    RecordedFilm recorded(run, scene, threads.step, context);
    if (wanted.fps > recorded.rate_hz() * (1.0 + 1e-9))
        log::warn(options.folder + ": has poses of " + exact_number(recorded.rate_hz()) +
                  " instants a second; pictures between two show the earlier one (--simulate: their own)");
    // Nothing is stepped: what describing and encoding leave over draws.
    const int encoding = options.film.video == "none" || options.film.video.empty() ? 0 : 1;
    Exposed exposed;
    const std::unique_ptr<Film> film =
        open_film(options, scene, threads.film, exposed, std::max(1, options.threads - 1 - encoding));
    const std::int64_t end = end_of(options, recorded.steps(), scene.step.dt_s);
    const std::int64_t done = recorded.film(*film, end);
    close_film(options, *film);
    if (done < end) throw UserError("stopped after step " + std::to_string(done) + " of " + std::to_string(end));
    std::printf("%s: %zu pictures of %lld steps, from its poses; %zu exposed, open surfaces met in %zu\n",
                options.folder.c_str(), film->frames(), static_cast<long long>(done), exposed.pictures, exposed.open);
}

void replay(const ReplayOptions& options, AppContext& context) {
    const RunRecord run = read_run(options.folder);
    const SceneSpec scene = recorded_scene(run, context);
    std::optional<RunVerifier> verifier;
    if (options.verify) verifier.emplace(run);
    const ThreadShares threads = share_threads(options.threads, pictured(options));
    Session session(scene, run.manifest.seed, threads.step, context);
    if (session.anatomy_hash() != run.manifest.anatomy_hash)
        throw UserError(options.folder + ": the anatomy is built otherwise than when this run was recorded");
    Exposed exposed;
    std::unique_ptr<Film> film;
    if (pictured(options)) film = open_film(options, scene, threads.film, exposed);
    Progress progress("replaying");
    std::int64_t k = 0;
    const std::int64_t end = end_of(options, run.steps, session.dt());
    bool agrees = true;
    for (; k < end && agrees && !stop_wanted(); ++k) {
        agrees = !verifier || verifier->state(k, session.world());
        if (!agrees) break;
        session.step(run.input_at(k));
        if (verifier) verifier->channels(k, session.channels());
        if (film) {
            for (const Event& event : session.events()) film->message(event);
            while (film->due(session.channels().time_s)) film->add(session.world(), session.channels());
        }
        progress.update(static_cast<double>(k + 1) / static_cast<double>(end));
    }
    progress.end();
    if (film) close_film(options, *film);
    if (agrees && verifier) agrees = verifier->state(k, session.world());
    if (!agrees) throw UserError(options.folder + ": " + verifier->difference());
    if (k < end) throw UserError("stopped after step " + std::to_string(k) + " of " + std::to_string(end));
    if (verifier && !verifier->channels_agree())
        throw UserError(options.folder + ": " + verifier->channel_difference());
    std::printf("%s: %lld steps replayed", options.folder.c_str(), static_cast<long long>(k));
    if (verifier) std::printf(", %zu state hashes and every channel agree", verifier->compared());
    if (film) std::printf("; %zu pictures exposed, open surfaces met in %zu", exposed.pictures, exposed.open);
    std::printf("\n");
}

}  // namespace

void add_replay_command(CLI::App& app, AppContext& context) {
    const auto options = std::make_shared<ReplayOptions>();
    CLI::App* command = app.add_subcommand("replay", "Do a recorded run again from step 0");
    command->add_option("DIR", options->folder, "a run folder")->required();
    command->add_flag("--verify", options->verify, "compare every recorded state hash and channel");
    add_film_options(*command, options->film, "film it: .mp4 or .avi (lossless)");
    command->add_option("--threads", options->threads, "in all; from 2 on one of them draws the film")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    command->callback([options, &context] {
        options->out = options->folder;
        replay(*options, context);
    });
}

void add_render_command(CLI::App& app, AppContext& context) {
    const auto options = std::make_shared<ReplayOptions>();
    CLI::App* command =
        app.add_subcommand("render", "Make film, labels and other pictures of a recorded run again, from elsewhere");
    command->add_option("DIR", options->folder, "a run folder")->required();
    command->add_option("--out", options->out, "a folder for film and labels; else DIR/render");
    add_film_options(*command, options->film, "the film: .mp4, .avi (lossless), or none; else fluoro.mp4 in --out");
    ViewChange& view = options->film.view;
    command->add_option("--primary", view.primary_deg, "deg, positive = LAO; else as in the run")
        ->check(CLI::Range(-180.0, 180.0));
    command->add_option("--secondary", view.secondary_deg, "deg, positive = cranial")->check(CLI::Range(-90.0, 90.0));
    command
        ->add_option_function<std::string>(
            "--view",
            [&view](const std::string& name) {
                const ViewPreset& preset = *find_view(name);
                view.primary_deg = preset.primary_deg;
                view.secondary_deg = preset.secondary_deg;
            },
            "both angles by a name: see `cathlab list views`")
        ->check(CLI::IsMember(view_names()))
        ->excludes("--primary")
        ->excludes("--secondary");
    command->add_option("--collimator-width", view.open_width, "share of the field's width that is open")
        ->check(CLI::Range(0.1, 1.0));
    command->add_option("--collimator-height", view.open_height, "share of its height")->check(CLI::Range(0.1, 1.0));
    command->add_option("--sid", view.sid_mm, "mm, source to detector")->check(CLI::Range(600.0, 1500.0));
    command->add_option("--sod", view.sod_mm, "mm, source to isocentre")->check(CLI::Range(400.0, 1200.0));
    command->add_option("--field-of-view", view.field_mm, "mm, side of the detector's field")
        ->check(CLI::Range(50.0, 500.0));
    command->add_option("--isocentre", view.isocentre, "X Y Z in mm, in the patient")->expected(3);
    command
        ->add_option("--kerma", view.kerma_ngy, "nGy at the detector a picture: 20 low, 40 normal, 80 high, 170 cine")
        ->check(CLI::Range(1.0, 10000.0));
    command->add_option("--kvp", view.kvp, "kV, tube voltage")->check(CLI::Range(40.0, 150.0));
    command->add_option("--detector", view.detector, "flat_panel or image_intensifier")
        ->check(CLI::IsMember({"flat_panel", "image_intensifier"}));
    command->add_flag("--beam-on", view.beam_on, "expose every picture, whether the pedal was down or not");
    command->add_option("--third-person", view.third_person, "the view from outside too, its wall coloured by this")
        ->check(CLI::IsMember({"force", "displacement"}));
    command->add_flag("--fluoroscopy-alone", view.alone, "without inner view and panels");
    command->add_option("--from", view.from_s, "s, of the first picture")->check(CLI::Range(0.0, 86400.0));
    command->add_option("--to", options->to_s, "s, where it ends; else with the run")->check(CLI::Range(0.02, 86400.0));
    command->add_option("--still", options->still, "a PNG file: the last picture");
    command->add_flag("--simulate", options->simulate, "step the run again, even where its folder has poses.bin");
    command->add_option("--threads", options->threads, "in all; from 2 on one of them draws the film")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    command->callback([options, &context] {
        if (options->out.empty()) options->out = options->folder + "/render";
        std::error_code error;
        std::filesystem::create_directories(options->out, error);
        if (error) throw UserError("cannot make the folder '" + options->out + "': " + error.message());
        if (options->film.video.empty() && options->still.empty()) options->film.video = options->out + "/fluoro.mp4";
        const RunRecord run = read_run(options->folder);
        if (!options->simulate && has_poses(options->folder)) {
            render_poses(*options, run, context);
            return;
        }
        if (!options->simulate) log::warn(options->folder + ": has no poses.bin, so the run is stepped again");
        replay(*options, context);
    });
}

}  // namespace cathlab
