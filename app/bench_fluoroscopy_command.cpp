// cathlab bench fluoroscopy: the whole chain of an X-ray picture, part by part, with the C-arm still and turning.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "bench_samples.h"
#include "commands.h"
#include "core/errors.h"
#include "core/hash.h"
#include "describe_frame.h"
#include "progress.h"
#include "render/frame_renderer.h"
#include "render/gl_target.h"
#include "run_options.h"
#include "scene/load_scene.h"
#include "scene/script.h"
#include "session.h"
#include "take_poses.h"

namespace cathlab {
namespace {

using Json = nlohmann::ordered_json;

constexpr int instants = 12;                     // that are drawn again and again
constexpr double instants_hz = 15.0;             // the last ones of the simulated time
constexpr double turn_deg = 25.0 / instants_hz;  // of the C-arm from picture to picture: what a quick one does

struct FluoroscopyBenchOptions {
    std::string scene = "demo";
    double seconds = 2.0;
    std::vector<int> sizes = {512, 1024};
    std::vector<int> threads = {1, 4};
    int pictures = 60;
    bool json = false;
};

/// The scene's last instants as the renderer gets them, exposed each; turning: from another angle each.
struct Takes {
    std::vector<FrameDescription> still, turning;
    std::string scene;
};

std::vector<double> isocentre_of(const CArmView& view) {
    const Vec3 p = view.source + view.source_isocentre_mm * (view.detector_center - view.source).normalized();
    return {p.x(), p.y(), p.z()};
}

Takes play(const FluoroscopyBenchOptions& options, const AppContext& context) {
    require_finite("--seconds", options.seconds);
    const SceneSpec scene = load_scene(find_scene(options.scene, context.data_root), {}, context.data_root);
    const Script script = scene.script.empty() ? Script() : Script::load(scene.script);
    const int threads = *std::max_element(options.threads.begin(), options.threads.end());
    Session session(scene, scene.seed, threads, context);
    const Input base = session.base_input();
    const auto steps = std::max<std::int64_t>(1, std::llround(options.seconds / session.dt()));
    const auto apart = std::max<std::int64_t>(1, std::llround(1.0 / instants_hz / session.dt()));
    Takes out;
    out.scene = scene.name;
    FrameMemory memory;
    ScenePoses poses;
    std::vector<double> isocentre;
    Progress progress("simulating", options.json);
    for (std::int64_t k = 0; k < steps && !stop_wanted(); ++k) {
        session.step(script.at(static_cast<double>(k) * session.dt(), base));
        progress.update(static_cast<double>(k + 1) / static_cast<double>(steps));
        const std::int64_t left = steps - 1 - k;
        if (left % apart != 0 || left / apart >= instants) continue;
        take_poses(session.world(), poses);
        const Channels& channels = session.channels();
        ViewChange change;
        change.beam_on = true;
        change.alone = true;
        FrameDescription frame;
        frame.seed = scene.seed;
        frame.frame_index = out.still.size();
        // Angles and table are held: a script that moves them would mix the two measurements.
        change.primary_deg = base.primary_angle;
        change.secondary_deg = base.secondary_angle;
        change.isocentre = isocentre;
        describe_frame(stage_of(session.world()), poses, scene, channels, change, memory, frame);
        if (isocentre.empty()) isocentre = isocentre_of(frame.view);
        out.still.push_back(frame);
        change.primary_deg = *change.primary_deg + turn_deg * static_cast<double>(out.turning.size() + 1);
        describe_frame(stage_of(session.world()), poses, scene, channels, change, memory, frame);
        out.turning.push_back(frame);
    }
    progress.end();
    if (out.still.empty()) throw UserError("stopped before the first picture");
    return out;
}

/// Milliseconds by part, the pictures' bits and what of them is open.
struct Drawn {
    Samples picture;
    std::map<std::string, double> parts;  // sums
    std::uint64_t hash = 0;
    std::size_t open_rays = 0;
};

Drawn draw(std::vector<FrameDescription>& takes, int size, int threads, int pictures) {
    using Clock = std::chrono::steady_clock;
    FrameRenderer renderer(make_gl_target(), Workers(threads));
    Drawn out;
    Hash64 hash;
    Image8 picture;
    // Once through for the caches and for the bits.
    for (FrameDescription& take : takes) {
        take.width = take.height = size;
        renderer.render(take, picture);
        hash.bytes(renderer.fluoroscopy().data(), renderer.fluoroscopy().size());
        out.open_rays += renderer.bad_pixels();
    }
    out.hash = hash.value();
    std::string part;
    Clock::time_point since;
    renderer.set_fluoroscopy_probe([&](std::string_view name) {
        const auto now = Clock::now();
        if (!part.empty()) out.parts[part] += std::chrono::duration<double, std::milli>(now - since).count();
        part = std::string(name);
        since = now;
    });
    for (int k = 0; k < pictures; ++k) {
        const FrameDescription& take = takes[static_cast<std::size_t>(k) % takes.size()];
        out.picture.add(ms_of([&] { renderer.render(take, picture); }));
        out.open_rays += renderer.bad_pixels();
    }
    return out;
}

void print(const Json& out) {
    std::printf("%s: the last %zu instants of %g s, %zu triangles of lumen, %zu pieces of devices, %zu solids\n",
                out["scene"].get<std::string>().c_str(), out["instants"].get<std::size_t>(),
                out["seconds"].get<double>(), out["triangles"].get<std::size_t>(),
                out["device_pieces"].get<std::size_t>(), out["solids"].get<std::size_t>());
    for (const Json& run : out["runs"]) {
        std::printf("%4dx%-4d %2d thread%s C-arm %-8s median %7.2f ms, p99 %7.2f ms: %6.1f a second\n",
                    run["size"].get<int>(), run["size"].get<int>(), run["threads"].get<int>(),
                    run["threads"].get<int>() == 1 ? ", " : "s,", run["c_arm"].get<std::string>().c_str(),
                    run["median_ms"].get<double>(), run["p99_ms"].get<double>(), run["per_second"].get<double>());
        std::printf("         ");
        for (const auto& [part, ms] : run["mean_ms"].items()) std::printf(" %s %.2f", part.c_str(), ms.get<double>());
        std::printf("\n");
    }
    std::printf("rays that enter what they do not leave: %zu; pictures on any threads %s\n",
                out["open_rays"].get<std::size_t>(), out["same_bytes"].get<bool>() ? "the same bytes" : "DIFFER");
}

void bench_fluoroscopy(const FluoroscopyBenchOptions& options, const AppContext& context) {
    Takes takes = play(options, context);
    const FrameDescription& first = takes.still.front();
    std::size_t pieces = 0;
    for (const FrameDevice& device : first.devices) pieces += device.radius_mm.size();
    Json out{{"scene", takes.scene},
             {"seconds", options.seconds},
             {"instants", takes.still.size()},
             {"triangles", first.lumen.triangles.size()},
             {"device_pieces", pieces},
             {"solids", first.solids.size()},
             {"machine_threads", std::thread::hardware_concurrency()},
             {"open_rays", 0},
             {"same_bytes", true},
             {"runs", Json::array()}};
    std::map<std::pair<int, bool>, std::uint64_t> hashes;
    std::size_t open_rays = 0, done = 0;
    Progress progress("drawing", options.json);
    for (const int size : options.sizes) {
        for (const int threads : options.threads) {
            for (const bool turning : {false, true}) {
                if (stop_wanted()) throw UserError("stopped");
                Drawn drawn = draw(turning ? takes.turning : takes.still, size, threads, options.pictures);
                const auto [known, is_new] = hashes.emplace(std::pair(size, turning), drawn.hash);
                if (!is_new && known->second != drawn.hash) out["same_bytes"] = false;
                open_rays += drawn.open_rays;
                Json run = {{"size", size}, {"threads", threads}, {"c_arm", turning ? "turning" : "still"}};
                run.update(drawn.picture.json());
                run["per_second"] = 1e3 / drawn.picture.median();
                for (const auto& [part, ms] : drawn.parts) run["mean_ms"][part] = ms / options.pictures;
                out["runs"].push_back(run);
                progress.update(static_cast<double>(++done) /
                                static_cast<double>(2 * options.sizes.size() * options.threads.size()));
            }
        }
    }
    progress.end();
    out["open_rays"] = open_rays;
    if (options.json)
        std::printf("%s\n", out.dump(2).c_str());
    else
        print(out);
}

}  // namespace

void add_bench_fluoroscopy_command(CLI::App& bench, AppContext& context) {
    const auto options = std::make_shared<FluoroscopyBenchOptions>();
    CLI::App* command =
        bench.add_subcommand("fluoroscopy", "An X-ray picture, part by part, with the C-arm still and turning");
    command->add_flag("--json", options->json, "As JSON");
    command->add_option("--scene", options->scene, "a scene file, or the name of one in scenes/")
        ->capture_default_str();
    command->add_option("--seconds", options->seconds, "simulated time by the scene's script; its end is drawn")
        ->check(CLI::Range(0.02, 3600.0))
        ->capture_default_str();
    command->add_option("--size", options->sizes, "pixels a side, one run for each")
        ->check(CLI::Range(64, 4096))
        ->capture_default_str();
    command->add_option("--threads", options->threads, "one run for each")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    command->add_option("--pictures", options->pictures, "that are timed in each run")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    command->callback([options, &context] { bench_fluoroscopy(*options, context); });
}

}  // namespace cathlab
