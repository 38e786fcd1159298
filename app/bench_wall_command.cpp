// cathlab bench wall: the soft wall's speed beside its peer and what the machine could do, all in one run.
#include <malloc.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench_samples.h"
#include "bench_wall.h"
#include "commands.h"
#include "core/errors.h"
#include "peer/bullet_clusters.h"
#include "progress.h"
#include "softbody/kernel.h"

namespace cathlab {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t particles = 10'000;
constexpr double matching = 0.8;  // of Bullet's clusters, as t_c

struct WallBenchOptions {
    int threads = 3;
    bool json = false;
    bool quick = false;
};

/// Another process that takes a core for as long as this lives.
class OtherProcess {
public:
    OtherProcess() : child_(::fork()) {
        if (child_ < 0) throw UserError("no second process could be started to take a core");
        if (child_ > 0) return;
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it ends with this program, however that ends
        volatile unsigned turns = 0;
        for (;;) turns = turns + 1;
    }
    ~OtherProcess() {
        ::kill(child_, SIGKILL);
        ::waitpid(child_, nullptr, 0);
    }
    OtherProcess(const OtherProcess&) = delete;
    OtherProcess& operator=(const OtherProcess&) = delete;

private:
    pid_t child_;
};

/// Turn by turn, so that an hour in which the machine is slow is slow for all of them.
Json measure_beside_peer(const WallBenchOptions& options, Progress& progress) {
    BenchWall wall(particles);
    const SoftBodyModel& model = wall.model();
    BulletClusters bullet(model, matching, ClusterTree::none), with_tree(model, matching, ClusterTree::kept);
    std::vector<Vec3> way;
    for (const Vec3& v : wall.push()) way.emplace_back(wall_step_s * v);
    const Arithmetic work = step_operations(model);
    const Arithmetic all_float{work.in_float + work.in_double, {}};
    const double bytes = wall_passes * pass_bytes(model);
    CopyTimer copy(static_cast<std::size_t>(pass_bytes(model)));
    const Workers alone(1), together(options.threads);

    const int turns = options.quick ? 2 : 30, steps = options.quick ? 10 : 100, others = options.quick ? 1 : 5;
    Samples one, several, crowded, pass, tree_pass, floor, float_floor, copying;
    for (int turn = 0; turn < turns; ++turn) {
        progress.update(0.5 * turn / turns, "10,000 particles");
        for (int k = 0; k < steps; ++k) one.add(wall.step_ms(alone));
        for (int k = 0; k < others; ++k) {
            floor.add(arithmetic_ms(work));
            float_floor.add(arithmetic_ms(all_float));
            copying.add(copy.ms());
            bullet.displace(way);
            with_tree.displace(way);
            for (Vec3& w : way) w = -w;
            pass.add(ms_of([&] { bullet.pass(); }));
            tree_pass.add(ms_of([&] { with_tree.pass(); }));
        }
        for (int k = 0; k < steps; ++k) several.add(wall.step_ms(together));
    }
    {
        const OtherProcess other;
        for (int k = 0; k < turns * steps; ++k) crowded.add(wall.step_ms(together));
    }

    const double ours = one.median(), memory = wall_passes * copying.median();
    const auto count = [](const Arithmetic& of) {
        return of.in_float.products + of.in_float.sums + of.in_double.products + of.in_double.sums;
    };
    Json out;
    out["wall"] = {{"particles", model.size()},
                   {"clusters", model.cluster_count},
                   {"memberships", model.membership_count()},
                   {"passes", wall_passes},
                   {"precision", "float fits, double states"},
                   {"instructions", kernel::best().name}};
    out["one_thread"] = one.json();
    out["threads"] = several.json();
    out["threads"]["threads"] = options.threads;
    out["threads"]["times_faster"] = ours / several.median();
    out["core_taken"] = crowded.json();
    out["core_taken"]["threads"] = options.threads;
    out["core_taken"]["p99_over_median"] = crowded.p99() / crowded.median();
    out["arithmetic_floor"] = {{"operations", count(work)},
                               {"ms", floor.median()},
                               {"times_floor", ours / floor.median()},
                               {"all_in_float_ms", float_floor.median()},
                               {"times_all_in_float", ours / float_floor.median()}};
    out["memory_floor"] = {{"bytes", bytes},
                           {"copy_gb_per_s", pass_bytes(model) / copying.median() * 1e-6},
                           {"ms", memory},
                           {"times_floor", ours / memory}};
    out["peer"] = {{"name", "Bullet, btSoftBody::updateClusters, double"},
                   {"passes", 1},
                   {"median_ms", pass.median()},
                   {"p99_ms", pass.p99()},
                   {"pass_over_our_pass", pass.median() / (ours / wall_passes)},
                   {"pass_over_our_step", pass.median() / ours},
                   {"with_tree_median_ms", tree_pass.median()},
                   {"with_tree_over_our_pass", tree_pass.median() / (ours / wall_passes)}};
    return out;
}

double heap_bytes() {
    const struct mallinfo2 now = ::mallinfo2();
    return static_cast<double>(now.uordblks + now.hblkhd);
}

/// Walls of one shape, the larger the finer their particles and clusters lie in it.
Json measure_sizes(const WallBenchOptions& options, Progress& progress) {
    std::vector<std::size_t> counts{1'000, 10'000, 100'000};
    if (!options.quick) counts.push_back(1'000'000);
    const Workers alone(1);
    Json rows = Json::array();
    for (const std::size_t count : counts) {
        progress.update(0.5 + 0.1 * static_cast<double>(rows.size()), std::to_string(count) + " particles");
        const double heap = heap_bytes();
        std::unique_ptr<BenchWall> wall;
        const double building = ms_of([&] { wall = std::make_unique<BenchWall>(count); });
        Samples step;
        const std::size_t steps = std::clamp<std::size_t>((options.quick ? 200'000 : 20'000'000) / count, 3, 4000);
        for (std::size_t k = 0; k < steps; ++k) step.add(wall->step_ms(alone));
        const auto n = static_cast<double>(wall->model().size());
        const auto memberships = static_cast<double>(wall->model().membership_count());
        rows.push_back({{"particles", wall->model().size()},
                        {"memberships", wall->model().membership_count()},
                        {"median_ms", step.median()},
                        {"ns_per_particle", 1e6 * step.median() / n},
                        {"ns_per_membership", 1e6 * step.median() / memberships},
                        {"bytes_per_particle", (heap_bytes() - heap) / n},
                        {"build_s", 1e-3 * building}});
    }
    return rows;
}

/// Largest over smallest.
double spread(const Json& rows, const char* key) {
    double low = rows.front().at(key), high = low;
    for (const Json& row : rows) {
        low = std::min(low, row.at(key).get<double>());
        high = std::max(high, row.at(key).get<double>());
    }
    return low > 0.0 ? high / low : 0.0;
}

void print(const Json& all) {
    const auto number = [&](const char* of, const char* key) { return all.at(of).at(key).get<double>(); };
    std::printf("wall of %.0f particles, %.0f clusters, %.0f memberships, a step of %d passes; float fits, %s\n",
                number("wall", "particles"), number("wall", "clusters"), number("wall", "memberships"), wall_passes,
                all.at("wall").at("instructions").get<std::string>().c_str());
    std::printf("%-34s %10s %10s\n", "", "median ms", "p99");
    const auto line = [&](const char* name, const char* of) {
        std::printf("%-34s %10.3f %10.3f", name, number(of, "median_ms"), number(of, "p99_ms"));
    };
    line("1 thread", "one_thread");
    std::printf("\n");
    char name[64];
    std::snprintf(name, sizeof name, "%.0f threads", number("threads", "threads"));
    line(name, "threads");
    std::printf("   %.2f times faster\n", number("threads", "times_faster"));
    std::snprintf(name, sizeof name, "%.0f threads, a core taken", number("threads", "threads"));
    line(name, "core_taken");
    std::printf("   p99 = %.2f x median\n", number("core_taken", "p99_over_median"));
    line("Bullet, one pass, 1 thread", "peer");
    std::printf("   %.1f of our passes, %.2f of our steps\n", number("peer", "pass_over_our_pass"),
                number("peer", "pass_over_our_step"));
    std::printf("%-34s %10.3f %10s   %.1f of our passes\n", "the same with its collision tree",
                number("peer", "with_tree_median_ms"), "", number("peer", "with_tree_over_our_pass"));
    std::printf("%-34s %10.3f %10s   ours is %.2f x that; %.1f million operations\n", "arithmetic floor",
                number("arithmetic_floor", "ms"), "", number("arithmetic_floor", "times_floor"),
                1e-6 * number("arithmetic_floor", "operations"));
    std::printf("%-34s %10.3f %10s   ours is %.2f x that\n", "the same, were all of it float",
                number("arithmetic_floor", "all_in_float_ms"), "", number("arithmetic_floor", "times_all_in_float"));
    std::printf("%-34s %10.3f %10s   ours is %.2f x that; %.1f MB at %.1f GB/s\n", "memory floor",
                number("memory_floor", "ms"), "", number("memory_floor", "times_floor"),
                1e-6 * number("memory_floor", "bytes"), number("memory_floor", "copy_gb_per_s"));
    std::printf("\n%10s %12s %10s %12s %14s %16s %8s\n", "particles", "memberships", "ms", "ns/particle",
                "ns/membership", "bytes/particle", "built s");
    for (const Json& row : all.at("sizes"))
        std::printf("%10.0f %12.0f %10.3f %12.1f %14.2f %16.0f %8.2f\n", row.at("particles").get<double>(),
                    row.at("memberships").get<double>(), row.at("median_ms").get<double>(),
                    row.at("ns_per_particle").get<double>(), row.at("ns_per_membership").get<double>(),
                    row.at("bytes_per_particle").get<double>(), row.at("build_s").get<double>());
    std::printf("largest over smallest: %.2f in time, %.2f in memory, a particle\n", number("spread", "time"),
                number("spread", "memory"));
}

void bench_wall(const WallBenchOptions& options) {
    Progress progress("benchmark", options.json);
    Json all = measure_beside_peer(options, progress);
    all["machine"] = {{"threads", std::thread::hardware_concurrency()}};
    all["sizes"] = measure_sizes(options, progress);
    all["spread"] = {{"time", spread(all["sizes"], "ns_per_particle")},
                     {"memory", spread(all["sizes"], "bytes_per_particle")}};
    progress.end();
    if (options.json)
        std::printf("%s\n", all.dump(2).c_str());
    else
        print(all);
}

}  // namespace

void add_bench_wall_command(CLI::App& bench) {
    const auto options = std::make_shared<WallBenchOptions>();
    CLI::App* command = bench.add_subcommand(
        "wall", "The soft wall alone: on one thread and several, beside Bullet, beside the machine's own floor");
    command->add_option("--threads", options->threads, "for the lines of several threads")
        ->check(CLI::Range(2, 256))
        ->capture_default_str();
    command->add_flag("--json", options->json, "As JSON");
    command->add_flag("--quick", options->quick, "Few steps, and without the million particles");
    command->callback([options] { bench_wall(*options); });
}

}  // namespace cathlab
