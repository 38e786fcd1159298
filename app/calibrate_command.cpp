// cathlab calibrate: the wall from a stress-strain curve, the heart from the motion of the annulus.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "calibrate/report.h"
#include "calibrate_output.h"
#include "commands.h"
#include "contact_check.h"
#include "core/errors.h"
#include "progress.h"
#include "run_options.h"
#include "scene/load_scene.h"
#include "session.h"

namespace cathlab {
namespace {

/// What both calibrations are asked.
struct CommonOptions {
    std::string reference, scene, out = "overlay.toml", report;
    std::vector<std::string> overlays;
    SwarmOptions swarm;
};

struct WallOptions : CommonOptions {
    std::vector<std::string> free;
    std::string stress = "hoop";
    std::string rig = "scenes/rigs/stress_strain.toml";
    std::string range;
    int polish = WallSearch{}.polish_evaluations;
    ContactCheck contact;
};

struct HeartOptions : CommonOptions {
    std::string positive = "apex";
    std::string objective = "rmse";
    int knots = HeartSearch{}.knots;
    int beats = HeartSearch{}.beats;
    double reach_mm = HeartSearch{}.reach_mm;
};

void require_finite(const CommonOptions& options) {
    cathlab::require_finite("--omega", options.swarm.omega);
    cathlab::require_finite("--eta1", options.swarm.eta1);
    cathlab::require_finite("--eta2", options.swarm.eta2);
}

// What is wrong with --free is wrong use, though it is a scene that says what there is.
Bound free_bound(const std::string& text) {
    const FreeRange range = parse_free(text);
    try {
        return named_bound(range.path, range.low, range.high);
    } catch (const UserError& error) {
        throw UserError("--free: " + std::string(error.what()), true);
    }
}

void say_end(bool stopped, const CalibrationOutput& output, AppContext& context) {
    std::printf("written: %s\n", output.places().c_str());
    if (!stopped) return;
    context.exit_code = 1;
    std::fprintf(stderr, "cathlab: stopped; what is written is the best found until then\n");
}

std::string best_text(const char* what, double value, const char* unit) {
    if (!std::isfinite(value)) return "no curve yet";
    return std::string(what) + " " + plain_number(value, 3) + " " + unit + " so far";
}

// A line is searched by fewer than a space is.
int usual_particles(const WallSearch& search) {
    const std::size_t free =
        search.free.empty() ? default_wall_bounds(search.scene, search.rig.stress).size() : search.free.size();
    constexpr int most = 20, on_a_line = 8, on_a_plane = 14;
    return free == 1 ? on_a_line : free == 2 ? on_a_plane : most;
}

// Stations stand in an anatomy, which may have to be built first.
WallRig read_rig(const SceneSpec& scene, int threads, const AppContext& context) {
    catch_stop_signals();
    Progress progress("building");
    WallRig rig = wall_rig(scene, {context.cache_folder, threads, [&](double fraction, std::string_view what) {
                                       if (stop_wanted()) throw UserError("stopped while the anatomy was being built");
                                       progress.update(fraction, std::string(what));
                                   }});
    progress.end();
    return rig;
}

void calibrate(const WallOptions& options, AppContext& context) {
    require_finite(options);
    WallSearch search;
    for (const std::string& text : options.free) search.free.push_back(free_bound(text));
    StressStrain reference = read_stress_strain(options.reference);
    if (!options.range.empty()) {
        const auto [low, high] = parse_range("--range", options.range);
        reference = within(reference, low, high);
    }
    const std::string rig = find_scene(options.rig, context.data_root);
    search.rig = read_rig(load_scene(rig, {}, context.data_root), options.swarm.threads, context);
    search.rig.stress = options.stress == "paper"     ? RigStress::paper
                        : options.stress == "nominal" ? RigStress::nominal
                                                      : RigStress::hoop;
    check_against(reference, search.rig);
    search.scene = load_scene(options.scene.empty() ? rig : find_scene(options.scene, context.data_root),
                              options.overlays, context.data_root);
    const CalibrationOutput output(options.out, options.report);

    catch_stop_signals();
    Progress progress("calibrating the wall");
    search.swarm = options.swarm;
    if (search.swarm.particles == 0) search.swarm.particles = usual_particles(search);
    search.polish_evaluations = options.polish;
    const double all = search.swarm.particles * (search.swarm.generations + 1.0) + search.polish_evaluations;
    double best = 0.0;
    int done = 0;
    search.stop = stop_wanted;
    search.swarm.on_generation = [&](const SearchProgress& p) {
        best = p.best_value;
        done = p.evaluations;
        progress.update(done / all, best_text("RMSE", 100.0 * best, "% strain"));
        return !stop_wanted();
    };
    search.polish = [&](int evaluations) {
        progress.update((done + evaluations) / all, best_text("RMSE", 100.0 * best, "% strain"));
    };
    const WallCalibration found = calibrate_wall(reference, search);
    progress.end();

    const Page page = wall_page(reference, search, found, context.command_line);
    for (const PageTable& table : page.tables) std::printf("%s", table_text(table).c_str());
    if (search.rig.kind == RigKind::stations) std::printf("%s", table_text(page.details.front()).c_str());
    output.write(found.overlay,
                 {"wall, from " + path_for_manifest(options.reference, context.data_root),
                  "RMSE " + plain_number(100.0 * found.figures.rmse, 3) + " % strain, maximum " +
                      plain_number(100.0 * found.figures.maximum, 3) + " %; the stress is taken as " + options.stress,
                  "Made by: " + context.command_line},
                 page);
    say_end(found.stopped, output, context);
}

void calibrate(const HeartOptions& options, AppContext& context) {
    require_finite(options);
    cathlab::require_finite("--reach", options.reach_mm);
    HeartSearch search;
    search.scene = load_scene(find_scene(options.scene, context.data_root), options.overlays, context.data_root);
    search.target = annulus_target(read_beat_motion(options.reference, 60.0 / search.scene.heart.rate_bpm),
                                   options.positive == "apex");
    search.knots = options.knots;
    search.beats = options.beats;
    search.reach_mm = options.reach_mm;
    search.at_peaks = options.objective == "peaks";
    search.swarm = options.swarm;
    check(search);
    const CalibrationOutput output(options.out, options.report);

    catch_stop_signals();
    const auto models = session_models(heart_scene(search.scene), search.swarm.threads, context);
    Progress progress("calibrating the heart");
    const char* what = search.at_peaks ? "objective" : "RMSE";
    double best = 0.0;
    const double all = search.swarm.particles * (search.swarm.generations + 1.0) + 8.0;
    search.stop = stop_wanted;
    search.on_simulation = [&](int n) { progress.update(n / all, "looking for the start"); };
    search.swarm.on_generation = [&](const SearchProgress& p) {
        best = p.best_value;
        progress.update((p.evaluations + 4.0) / all, best_text(what, best, "mm"));
        return !stop_wanted();
    };
    const HeartCalibration found = calibrate_heart(search, *models);
    progress.end();

    const Page page = heart_page(search, found, options.reference, context.command_line);
    std::printf("%s", table_text(page.tables[0]).c_str());
    std::printf("rest pose of the vessels: phase %s of the reference\n",
                plain_number(search.target.rest_phase, 3).c_str());
    output.write(
        found.overlay,
        {"heart, from " + path_for_manifest(options.reference, context.data_root),
         "RMSE " + plain_number(found.figures.rmse, 3) + " mm, mean absolute " +
             plain_number(found.figures.mean_absolute, 3) + " mm at " + plain_number(search.scene.heart.rate_bpm) +
             " beats a minute; rest pose at phase " + plain_number(search.target.rest_phase, 3),
         "Made by: " + context.command_line},
        page);
    say_end(found.stopped, output, context);
}

void add_common(CLI::App& command, CommonOptions& options) {
    command.add_option("--overlay", options.overlays, "a file laid over the scene first; may be given again")
        ->allow_extra_args(false);
    CLI::Option* particles = command.add_option("--particles", options.swarm.particles, "of the swarm");
    particles->check(CLI::Range(2, 10000));
    if (options.swarm.particles > 0)
        particles->capture_default_str();
    else
        particles->default_str("20; 14 for two free numbers, 8 for one");
    command.add_option("--generations", options.swarm.generations, "of the swarm")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    command.add_option("--omega", options.swarm.omega, "inertia")->check(CLI::Range(0.0, 1.0))->capture_default_str();
    command.add_option("--eta1", options.swarm.eta1, "pull of a particle's own best")
        ->check(CLI::Range(0.0, 4.0))
        ->capture_default_str();
    command.add_option("--eta2", options.swarm.eta2, "pull of the swarm's best")
        ->check(CLI::Range(0.0, 4.0))
        ->capture_default_str();
    command.add_option("--seed", options.swarm.seed, "of the swarm's random numbers")
        ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{9007199254740991}))
        ->capture_default_str();
    command.add_option("--threads", options.swarm.threads, "worlds at the same time; the result is the same")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    command.add_option("--out", options.out, "the overlay: TOML to lay over any scene")->capture_default_str();
    command.add_option("--report", options.report, "a folder for report.html, made if need be");
}

}  // namespace

void add_calibrate_command(CLI::App& app, AppContext& context) {
    CLI::App* command = app.add_subcommand("calibrate", "Fit the wall or the heart to a reference");
    command->require_subcommand(1);

    const auto wall = std::make_shared<WallOptions>();
    wall->swarm.particles = 0;  // usual_particles()
    wall->swarm.generations = 15;
    wall->swarm.threads = default_threads();
    CLI::App* wall_command = command->add_subcommand("wall", "The wall, to a curve of stress and strain");
    wall_command->add_option("REFERENCE", wall->reference, "CSV with stress_kpa (or _mpa, _pa) and strain");
    wall_command->add_option(
        "--contact", wall->contact.folder,
        "a wall-contact data set to compare with instead; its material is given, nothing is fitted");
    wall_command->add_option("--spacing", wall->contact.particle_spacing_mm, "of the particles with --contact, mm")
        ->check(CLI::Range(0.5, 10.0))
        ->capture_default_str();
    wall_command->add_option("--scene", wall->scene, "gives [wall] and the effects to begin with; else the rig's own");
    wall_command
        ->add_option("--free", wall->free,
                     "PATH=LOW:HIGH, a number of the scene and where to look for it; may be given again; else "
                     "spacing, radius and stiffness of the clusters")
        ->allow_extra_args(false);
    wall_command
        ->add_option(
            "--stress", wall->stress,
            "what the reference's stress is: hoop (true, in the wall), nominal (by the section at rest), paper "
            "(a radial traction F / A)")
        ->check(CLI::IsMember({"hoop", "nominal", "paper"}))
        ->capture_default_str();
    wall_command
        ->add_option(
            "--rig", wall->rig,
            "a scene whose [rig] says what is loaded: scenes/rigs/ has a tube (the default), aorta, ring, strip "
            "and block")
        ->capture_default_str();
    wall_command->add_option("--range", wall->range, "LOW:HIGH, kPa: only these rows of the reference");
    wall_command->add_option("--polish", wall->polish, "curves of the local search after the swarm; 0 = none")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    add_common(*wall_command, *wall);
    wall_command->callback([wall, &context] {
        if (wall->reference.empty() == wall->contact.folder.empty())
            throw UserError("calibrate wall wants a REFERENCE.csv, or --contact DATASET", true);
        wall->contact.threads = wall->swarm.threads;
        if (wall->contact.folder.empty())
            calibrate(*wall, context);
        else
            check_contacts(wall->contact, context);
    });

    const auto heart = std::make_shared<HeartOptions>();
    heart->scene = "demo";
    heart->swarm.particles = 12;
    heart->swarm.generations = 5;
    heart->swarm.threads = default_threads();
    CLI::App* heart_command = command->add_subcommand("heart", "The heart's profile, to the motion of the annulus");
    heart_command
        ->add_option("REFERENCE", heart->reference,
                     "CSV of one beat with phase (or t_s, t_ms) and displacement_mm (or _cm, _m)")
        ->required();
    heart_command->add_option("--scene", heart->scene, "its anatomy, wall and heart; devices are left out")
        ->capture_default_str();
    heart_command->add_option("--positive", heart->positive, "where the reference counts to: apex or aorta")
        ->check(CLI::IsMember({"apex", "aorta"}))
        ->capture_default_str();
    heart_command->add_option("--objective", heart->objective, "rmse, or peaks: the error at the peaks of each beat")
        ->check(CLI::IsMember({"rmse", "peaks"}))
        ->capture_default_str();
    heart_command->add_option("--knots", heart->knots, "of the profile")
        ->check(CLI::Range(4, 64))
        ->capture_default_str();
    heart_command
        ->add_option("--reach", heart->reach_mm,
                     "mm that the swarm looks to either side of its start; 0 = three times the RMSE there")
        ->check(CLI::Range(0.0, 20.0))
        ->capture_default_str();
    heart_command->add_option("--beats", heart->beats, "that count, after one more")
        ->check(CLI::Range(1, 20))
        ->capture_default_str();
    add_common(*heart_command, *heart);
    heart_command->callback([heart, &context] { calibrate(*heart, context); });
}

}  // namespace cathlab
