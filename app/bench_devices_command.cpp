// cathlab bench wire, contact and step: the chain's solve, the questions to the wall, the whole coupled step.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench_samples.h"
#include "commands.h"
#include "core/random.h"
#include "progress.h"
#include "scene/load_scene.h"
#include "scene/script.h"
#include "session.h"
#include "step/parts.h"

namespace cathlab {
namespace {

using Json = nlohmann::ordered_json;

struct DeviceBenchOptions {
    std::string scene = "demo";
    double seconds = 10.0;
    std::vector<int> threads = {1, 3};
    bool json = false;
    bool quick = false;
};

/// 0.035 in, EI 1850 N mm2: the stiffest of the assets, in links of 3 mm.
WireSpec even_wire(double length_mm) {
    constexpr double ei_n_mm2 = 1850.0, diameter_mm = 0.889;
    WireSection section;
    section.length_mm = length_mm;
    section.diameter_mm = diameter_mm;
    section.bending_stiffness_n_mm2 = ei_n_mm2;
    section.torsion_stiffness_n_mm2 = ei_n_mm2 / 1.3;
    section.axial_stiffness_n = 16.0 * ei_n_mm2 / (diameter_mm * diameter_mm);
    section.density_kg_m3 = 7900.0;
    section.material = "stainless_steel";
    WireSpec spec;
    spec.name = "even";
    spec.length_mm = length_mm;
    spec.link_length_mm = 3.0;
    spec.sections = {section};
    return spec;
}

void bench_wire(const DeviceBenchOptions& options) {
    constexpr double h = 0.005, link_mm = 3.0;
    Json rows = Json::array();
    Progress progress("benchmark", options.json);
    for (const int links : {75, 150, 300, 600}) {
        progress.update(links / 700.0, std::to_string(links) + " links");
        Samples free, touching;
        for (const bool touches : {false, true}) {
            Rod rod(even_wire(link_mm * (links + 40)), {}, link_mm * links - 1.0);
            std::vector<ChainRow> contacts;
            for (std::size_t i = 0; touches && i < rod.free_link_count(); ++i) {
                ChainRow row;
                row.link = static_cast<Index>(i);
                row.normal = Vec3::UnitX();
                row.compliance = 1e-2;
                row.gap = i % 2 == 0 ? -0.01 : 0.02;
                row.friction = 0.1;
                contacts.push_back(row);
            }
            rod.command(0.0, 0.01);
            rod.predict(h);
            const int solves = (options.quick ? 3'000 : 150'000) / links;
            for (int k = 0; k < solves; ++k)
                (touches ? touching : free).add(processor_ms_of([&] { rod.solve(h, contacts); }));
        }
        rows.push_back({{"links", links},
                        {"free_median_ms", free.median()},
                        {"free_p99_ms", free.p99()},
                        {"us_per_link", 1e3 * free.median() / links},
                        {"touching_median_ms", touching.median()},
                        {"touching_p99_ms", touching.p99()}});
    }
    progress.end();
    if (options.json) {
        std::printf("%s\n", Json{{"solve", rows}}.dump(2).c_str());
        return;
    }
    std::printf("one solve of the wire's chain, one thread, processor time, ms\n");
    std::printf("%8s %12s %10s %12s %28s\n", "links", "free: median", "p99", "us a link", "a row on each: median");
    for (const Json& row : rows)
        std::printf("%8d %12.4f %10.4f %12.3f %28.4f\n", row["links"].get<int>(), row["free_median_ms"].get<double>(),
                    row["free_p99_ms"].get<double>(), row["us_per_link"].get<double>(),
                    row["touching_median_ms"].get<double>());
}

/// A scene in the middle of its script.
struct Played {
    explicit Played(const DeviceBenchOptions& options, const AppContext& context, int threads)
        : scene(load_scene(find_scene(options.scene, context.data_root), {}, context.data_root)),
          session(scene, scene.seed, threads, context),
          script(scene.script.empty() ? Script() : Script::load(scene.script)) {}
    void step() {
        session.step(script.at(static_cast<double>(steps) * session.dt(), session.base_input()));
        ++steps;
    }
    SceneSpec scene;
    Session session;
    Script script;
    std::int64_t steps = 0;
};

void bench_contact(const DeviceBenchOptions& options, const AppContext& context) {
    Played played(options, context, 1);
    Progress progress("benchmark", options.json);
    const auto count = std::max<std::int64_t>(1, std::llround(options.seconds / played.session.dt()));
    for (std::int64_t k = 0; k < count; ++k) {
        played.step();
        progress.update(0.5 * static_cast<double>(k) / static_cast<double>(count), "on its way");
    }
    const Parts p = find_parts(played.session.world());
    const Workers alone(1);

    // Points in the lumen, and the triangles that they were near before.
    std::vector<Vec3> points;
    std::vector<Index> hints;
    const auto& nodes = p.anatomy->centreline.nodes;
    for (std::uint64_t i = 0; i < 2000; ++i) {
        const CentrelineNode& node = nodes[i * 37 % nodes.size()];
        const auto draw = [&](std::uint64_t axis) {
            return node.radius * (1.6 * random_uniform(1, RandomStream::test, i, axis) - 0.8) / std::sqrt(3.0);
        };
        points.push_back(node.position + Vec3(draw(0), draw(1), draw(2)));
        hints.push_back(closest(*p.surface, *p.surface_state, points.back(), 50.0).triangle);
    }
    constexpr double margin_mm = 1.5, reach_mm = 8.0;
    Samples far, hinted, refit;
    const int rounds = options.quick ? 2 : 30;
    for (int k = 0; k < rounds; ++k) {
        progress.update(0.5 + 0.5 * k / rounds, "questions");
        refit.add(processor_ms_of([&] { update(*p.surface, p.wall_state->x, *p.surface_state, alone); }));
        far.add(processor_ms_of([&] {
            for (const Vec3& q : points) closest(*p.surface, *p.surface_state, q, reach_mm);
        }));
        hinted.add(processor_ms_of([&] {
            for (std::size_t i = 0; i < points.size(); ++i)
                closest(*p.surface, *p.surface_state, points[i], margin_mm, hints[i]);
        }));
    }
    progress.end();
    Json out{{"scene", played.scene.name},
             {"triangles", p.surface->triangles.size()},
             {"particles", p.wall->size()},
             {"rows", p.contacts->rows().size()},
             {"refit_median_ms", refit.median()},
             {"closest_us", 1e3 * far.median() / static_cast<double>(points.size())},
             {"closest_near_with_hint_us", 1e3 * hinted.median() / static_cast<double>(points.size())}};
    if (options.json) {
        std::printf("%s\n", out.dump(2).c_str());
        return;
    }
    std::printf("%s after %.1f s: %zu triangles over %zu particles, %zu rows; one thread, processor time\n",
                played.scene.name.c_str(), options.seconds, p.surface->triangles.size(), p.wall->size(),
                p.contacts->rows().size());
    std::printf("surface and boxes follow the wall, all of them   %10.3f ms\n", out["refit_median_ms"].get<double>());
    std::printf("closest point within %.0f mm                       %10.3f us\n", reach_mm,
                out["closest_us"].get<double>());
    std::printf("closest point within %.1f mm, from where it was    %10.3f us\n", margin_mm,
                out["closest_near_with_hint_us"].get<double>());
}

void bench_step(const DeviceBenchOptions& options, const AppContext& context) {
    Json out;
    for (const int threads : options.threads) {
        Played played(options, context, threads);
        const Parts p = find_parts(played.session.world());
        const auto count = std::max<std::int64_t>(1, std::llround(options.seconds / played.session.dt()));
        Progress progress("benchmark", options.json);
        Samples step;
        double deepest = 0.0;
        for (std::int64_t k = 0; k < count; ++k) {
            step.add(ms_of([&] { played.step(); }));
            const Channels& c = played.session.channels();
            deepest = std::max({deepest, c.wire_penetration_mm, c.catheter_penetration_mm});
            progress.update(static_cast<double>(k) / static_cast<double>(count), std::to_string(threads) + " threads");
        }
        progress.end();
        if (out.empty())
            out = {{"scene", played.scene.name},
                   {"dt_s", p.settings->dt},
                   {"substeps", p.settings->substeps},
                   {"iterations", p.settings->iterations},
                   {"particles", p.wall->size()},
                   {"triangles", p.surface->triangles.size()},
                   {"links", p.wire ? p.wire->link_count() : 0},
                   {"deepest_mm", deepest},
                   {"simulated_s", static_cast<double>(count) * played.session.dt()},
                   {"machine_threads", std::thread::hardware_concurrency()},
                   {"runs", Json::array()}};
        const double simulated = static_cast<double>(count) * played.session.dt();
        out["runs"].push_back({{"threads", threads},
                               {"median_ms", step.median()},
                               {"p99_ms", step.p99()},
                               {"s_per_simulated_s", 1e-3 * step.sum() / simulated}});
    }
    if (options.json) {
        std::printf("%s\n", out.dump(2).c_str());
        return;
    }
    std::printf(
        "%s: %zu particles, %zu triangles, %zu links in the end; a step of %g ms is %d substeps of %d iterations\n",
        out["scene"].get<std::string>().c_str(), out["particles"].get<std::size_t>(),
        out["triangles"].get<std::size_t>(), out["links"].get<std::size_t>(), 1e3 * out["dt_s"].get<double>(),
        out["substeps"].get<int>(), out["iterations"].get<int>());
    for (const Json& run : out["runs"])
        std::printf("%2d thread%s  median %.2f ms, p99 %.2f ms: %.3f s a simulated second\n", run["threads"].get<int>(),
                    run["threads"].get<int>() == 1 ? " " : "s", run["median_ms"].get<double>(),
                    run["p99_ms"].get<double>(), run["s_per_simulated_s"].get<double>());
    std::printf("deepest in the wall over %.1f s: %.3f mm\n", out["simulated_s"].get<double>(),
                out["deepest_mm"].get<double>());
}

}  // namespace

void add_bench_device_commands(CLI::App& bench, AppContext& context) {
    const auto options = std::make_shared<DeviceBenchOptions>();
    const auto add = [&](const char* name, const char* doc) {
        CLI::App* command = bench.add_subcommand(name, doc);
        command->add_flag("--json", options->json, "As JSON");
        return command;
    };
    const auto with_scene = [&](CLI::App* command) {
        command->add_option("--scene", options->scene, "a scene file, or the name of one in scenes/")
            ->capture_default_str();
        command->add_option("--seconds", options->seconds, "simulated time, by the scene's script")
            ->check(CLI::Range(0.02, 3600.0))
            ->capture_default_str();
    };
    CLI::App* wire = add("wire", "One solve of the wire's chain: free, and with a row on each link");
    wire->add_flag("--quick", options->quick, "Few solves");
    wire->callback([options] { bench_wire(*options); });
    CLI::App* contact = add("contact", "Questions for the closest point of the wall, and the surface that follows it");
    with_scene(contact);
    contact->add_flag("--quick", options->quick, "Few questions");
    contact->callback([options, &context] { bench_contact(*options, context); });
    CLI::App* step = add("step", "The whole coupled step, in seconds a simulated second");
    with_scene(step);
    step->add_option("--threads", options->threads, "one run for each")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    step->callback([options, &context] { bench_step(*options, context); });
}

}  // namespace cathlab
