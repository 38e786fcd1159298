// Our coupled step, whose wall gives way, beside a rigid vessel's in MuJoCo, by the same script in one run
// (docs/benchmarks.md).
#include <mujoco/mujoco.h>
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "rigid_vessel_wire.h"
#include "scene/build_world.h"
#include "scene/load_scene.h"
#include "scene/script.h"
#include "step/parts.h"
#include "step/step.h"

namespace cathlab {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
    std::string scene = "published";
    double seconds = 4.0;
    double budget_s = 60.0;
    double behind_mm = 80.0;
    double stiffness_n_mm2 = 75.0;  ///< the peer's wire is no stiffer than this
    double settle_s = 0.2;          ///< of the peer, before it is measured
    std::vector<int> links = {80, 320};
    std::vector<int> threads = {1, 3};
    PeerOptions peer;
    bool json = false;
};

/// Of all threads of this process, s.
double processor_s() {
    timespec t{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}
double clock_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// From behind_mm behind the sheath, straight, then along the centre-line to the heart.
LumenWay way_to_the_heart(const AnatomyModel& anatomy, const SceneSpec& scene, double behind_mm) {
    const auto entry = std::find_if(anatomy.entries.begin(), anatomy.entries.end(),
                                    [&](const EntrySite& site) { return site.name == scene.wire.entry; });
    if (entry == anatomy.entries.end() || !anatomy.annulus) throw std::runtime_error("no way from entry to annulus");
    const Vec3 inward = entry->pose.orientation * Vec3::UnitZ();
    LumenWay way;
    const auto add = [&](const Vec3& p, double radius) {
        way.points.push_back(p);
        way.radius.push_back(radius);
    };
    constexpr double apart_mm = 4.0;
    for (double behind = behind_mm; behind > apart_mm; behind -= apart_mm)
        add(entry->pose.position - behind * inward, entry->radius_mm);
    const std::size_t guide = way.points.size() + 1;
    add(entry->pose.position, entry->radius_mm);
    const CentrelineGraph& graph = anatomy.centreline;
    for (const Index i : graph.path(entry->node, graph.nearest(anatomy.annulus->pose.position))) {
        const CentrelineNode& node = graph.nodes[static_cast<std::size_t>(i)];
        const Vec3 step = node.position - way.points.back();
        if (step.norm() > 0.5 && (way.points.size() > guide || step.dot(inward) > 0.0)) add(node.position, node.radius);
    }
    return way;
}

struct Measured {
    double processor_s = 0.0, clock_s = 0.0, simulated_s = 0.0, deepest_mm = 0.0, gap_mm = 0.0;
};

Json peer_run(const LumenWay& way, const WireSpec& wire, const Script& script, const Options& options, int links) {
    PeerOptions peer = options.peer;
    peer.links = links;
    RigidVesselWire model(way, wire, peer);
    const double h = peer.timestep_s;
    model.settle(options.settle_s);
    Measured m;
    int contacts = 0, steps = 0, outside = 0;
    for (; m.simulated_s < options.seconds && m.processor_s < options.budget_s; ++steps) {
        const Input input = script.at(m.simulated_s);
        const bool mine = input.device < 0.5;
        const double p = processor_s(), c = clock_s();
        model.step(mine ? input.advance : 0.0, mine ? units::pi / 180.0 * input.rotate : 0.0);
        m.processor_s += processor_s() - p;
        m.clock_s += clock_s() - c;
        m.simulated_s += h;
        m.deepest_mm = std::max(m.deepest_mm, model.penetration_mm());
        m.gap_mm = std::max(m.gap_mm, model.joint_gap_mm());
        contacts += model.contacts();
        outside = std::max(outside, model.outside());
    }
    return {{"links", links},
            {"degrees_of_freedom", model.degrees_of_freedom()},
            {"boxes", model.boxes()},
            {"timestep_s", h},
            {"solver", peer.solver},
            {"contacts_mean", static_cast<double>(contacts) / steps},
            {"armature_kg_mm2", {model.armature_min(), model.armature_max()}},
            {"armature_over_own_inertia", model.armature_ratio()},
            {"faults", model.faults()},
            {"joints_outside", outside},
            {"simulated_s", m.simulated_s},
            {"fed_mm", model.fed_mm()},
            {"deepest_mm", m.deepest_mm},
            {"joint_gap_mm", m.gap_mm},
            {"processor_s_per_s", m.processor_s / m.simulated_s},
            {"clock_s_per_s", m.clock_s / m.simulated_s}};
}

Json our_run(const SceneSpec& scene, const SceneModels& models, const Script& script, double seconds, int threads) {
    const auto world = build_world(scene, models, scene.seed, threads);
    prepare(*world);
    const Parts p = find_parts(*world);
    Channels channels;
    Measured m;
    double stretch = 0.0;
    for (int k = 0; k * p.settings->dt < seconds; ++k) {
        const Input input = script.at(m.simulated_s);
        const double cpu = processor_s(), c = clock_s();
        step(*world, input, channels);
        m.processor_s += processor_s() - cpu;
        m.clock_s += clock_s() - c;
        m.simulated_s += p.settings->dt;
        m.deepest_mm = std::max({m.deepest_mm, channels.wire_penetration_mm, channels.catheter_penetration_mm});
        stretch = std::max(stretch, channels.wire_stretch_max);
        world->first<EventLog>()->pending.clear();
    }
    return {{"threads", threads},
            {"links", p.wire->link_count()},
            {"particles", p.wall->size()},
            {"substeps", p.settings->substeps},
            {"iterations", p.settings->iterations},
            {"simulated_s", m.simulated_s},
            {"deepest_mm", m.deepest_mm},
            {"stretch_percent", 100.0 * stretch},
            {"processor_s_per_s", m.processor_s / m.simulated_s},
            {"clock_s_per_s", m.clock_s / m.simulated_s}};
}

void print(const Json& out) {
    const auto number = [](const Json& row, const char* key) { return row[key].get<double>(); };
    std::printf("%-34s %9s %12s %12s %10s %10s\n", "", "simulated", "processor s", "clock s", "deepest", "joints");
    std::printf("%-34s %9s %12s %12s %10s %10s\n", "", "s", "a second", "a second", "mm", "");
    for (const Json& r : out["peer"]) {
        char name[80];
        std::snprintf(name, sizeof name, "MuJoCo %s, rigid, %d links", mj_versionString(), r["links"].get<int>());
        std::printf("%-34s %9.2f %12.3f %12.3f %10.3f %7.0e mm\n", name, number(r, "simulated_s"),
                    number(r, "processor_s_per_s"), number(r, "clock_s_per_s"), number(r, "deepest_mm"),
                    number(r, "joint_gap_mm"));
        std::printf(
            "  %d hinges, %d boxes, %.0f contacts, solver %s, step %g ms; armature %.2g to %.2g kg mm2, up to "
            "%.2g times a link's own inertia; %d faults, %d joints outside\n",
            r["degrees_of_freedom"].get<int>(), r["boxes"].get<int>(), number(r, "contacts_mean"),
            r["solver"].get<std::string>().c_str(), 1e3 * number(r, "timestep_s"),
            r["armature_kg_mm2"][0].get<double>(), r["armature_kg_mm2"][1].get<double>(),
            number(r, "armature_over_own_inertia"), r["faults"].get<int>(), r["joints_outside"].get<int>());
    }
    for (const Json& r : out["ours"]) {
        char name[80];
        std::snprintf(name, sizeof name, "ours, deforming, %d links, %d thread%s", r["links"].get<int>(),
                      r["threads"].get<int>(), r["threads"].get<int>() == 1 ? "" : "s");
        std::printf("%-34s %9.2f %12.3f %12.3f %10.3f %8.4f %%\n", name, number(r, "simulated_s"),
                    number(r, "processor_s_per_s"), number(r, "clock_s_per_s"), number(r, "deepest_mm"),
                    number(r, "stretch_percent"));
    }
    for (const Json& r : out["ratios"])
        std::printf("MuJoCo of %d links over ours on %d: %.1f by the clock\n", r["peer_links"].get<int>(),
                    r["our_threads"].get<int>(), number(r, "clock"));
}

void run(const Options& options) {
    const std::string root = CATHLAB_SOURCE_DIR;
    const SceneSpec scene = load_scene(find_scene(options.scene, root), {}, root);
    BuildOptions build;
    const auto program = std::filesystem::read_symlink("/proc/self/exe");
    build.cache_folder = (program.parent_path() / "models").string();
    const auto models = build_models(scene, build);
    const Script script = scene.script.empty() ? Script() : Script::load(scene.script);

    const auto world = build_world(scene, *models, scene.seed, 1);
    prepare(*world);
    const Parts parts = find_parts(*world);
    const LumenWay way = way_to_the_heart(*parts.anatomy, scene, options.behind_mm);
    WireSpec wire = parts.wire->spec();
    for (WireSection& section : wire.sections)
        section.bending_stiffness_n_mm2 = std::min(section.bending_stiffness_n_mm2, options.stiffness_n_mm2);
    Options with_wire = options;
    with_wire.peer.wire_mm = options.behind_mm + scene.wire.insertion_mm;
    with_wire.peer.friction = wire.friction;

    Json out{{"scene", scene.name},
             {"peer_stiffness_n_mm2", options.stiffness_n_mm2},
             {"peer", Json::array()},
             {"ours", Json::array()},
             {"ratios", Json::array()}};
    for (const int links : options.links) out["peer"].push_back(peer_run(way, wire, script, with_wire, links));
    for (const int threads : options.threads)
        out["ours"].push_back(our_run(scene, *models, script, options.seconds, threads));
    for (const Json& peer : out["peer"])
        for (const Json& ours : out["ours"])
            out["ratios"].push_back(
                {{"peer_links", peer["links"]},
                 {"our_threads", ours["threads"]},
                 {"clock", peer["clock_s_per_s"].get<double>() / ours["clock_s_per_s"].get<double>()},
                 {"processor", peer["processor_s_per_s"].get<double>() / ours["processor_s_per_s"].get<double>()}});
    if (options.json)
        std::printf("%s\n", out.dump(2).c_str());
    else
        print(out);
}

}  // namespace
}  // namespace cathlab

int main(int argc, char** argv) {
    cathlab::Options options;
    CLI::App app("The coupled step beside a wire in a rigid vessel in MuJoCo");
    app.add_option("--scene", options.scene, "ours, and where the peer's way comes from")->capture_default_str();
    app.add_option("--seconds", options.seconds, "simulated time")
        ->check(CLI::Range(0.02, 600.0))
        ->capture_default_str();
    app.add_option("--budget", options.budget_s, "processor time after which a peer's run ends, s")
        ->capture_default_str();
    app.add_option("--links", options.links, "of the peer's wire")->check(CLI::Range(2, 450))->capture_default_str();
    app.add_option("--threads", options.threads, "of ours")->check(CLI::Range(1, 256))->capture_default_str();
    app.add_option("--timestep", options.peer.timestep_s, "of the peer, s")->capture_default_str();
    app.add_option("--armature", options.peer.armature_steps, "of the peer's joints, in k h^2")->capture_default_str();
    app.add_option("--ring", options.peer.ring_mm, "from ring to ring of the peer's vessel, mm")->capture_default_str();
    app.add_option("--solver", options.peer.solver, "of the peer")
        ->check(CLI::IsMember({"Newton", "CG", "PGS"}))
        ->capture_default_str();
    app.add_option("--stiffness", options.stiffness_n_mm2, "largest EI of the peer's wire, N mm2")
        ->capture_default_str();
    app.add_option("--impedance", options.peer.impedance, "of the peer's contacts")->capture_default_str();
    app.add_flag("--twist", options.peer.twist, "a third hinge a link, about its axis");
    app.add_flag("--json", options.json, "As JSON");
    CLI11_PARSE(app, argc, argv);
    try {
        cathlab::run(options);
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
    return 0;
}
