// The tip of a robot of three segments, each bent by three tendons.
#include <sstream>

#include "explain/recording_parts.h"

namespace explain_test {
namespace {

using B = std::array<double, 2>;

/// Three segments bent by vectors, each cut into many short straight pieces.
V robot_tip(const std::array<B, 3>& bends, double taper) {
    constexpr int pieces = 30;
    constexpr double length = 40.0;
    V at{};
    M frame = identity();
    for (const B& b : bends) {
        const double size = std::hypot(b[0], b[1]), way = std::atan2(b[1], b[0]);
        for (int k = 0; k < pieces; ++k) {
            const double turn = size / pieces * (1.0 + taper * ((k + 0.5) / pieces * 2.0 - 1.0));
            const auto half = [&] {
                frame = times(times(times(frame, about(2, way)), about(1, 0.5 * turn)), about(2, -way));
            };
            half();
            go(at, frame, length / pieces);
            half();
        }
    }
    for (int k = 0; k < 3; ++k) at[k] += 3.0 * frame[0][k] + 2.0 * frame[2][k];  // the marker
    return at;
}

/// Where springs come to rest: a segment's own, and tendons of the same stiffness that run through all segments up to
/// theirs, hold by one another's tightness and go slack when they are let go.  One bend after another, each moved to
/// where its own pull vanishes.
std::array<B, 3> springs_at_rest(const std::array<B, 3>& wanted, const double* first, double give, double tight) {
    struct Spring {
        int up_to;
        double x, y, pulled;
    };
    std::vector<Spring> springs;
    for (int s = 0; s < 3; ++s)
        for (int k = 0; k < 3; ++k) {
            const double place = (first[s] + 120.0 * k) * rad, x = std::cos(place), y = std::sin(place);
            springs.push_back({s, x, y, wanted[s][0] * x + wanted[s][1] * y + tight});
        }
    std::array<B, 3> b{};
    for (int round = 0; round < 400; ++round)
        for (int s = 0; s < 3; ++s)
            for (int a = 0; a < 2; ++a) {
                double pull = -give * b[s][a], stiff = give;
                for (const Spring& spring : springs) {
                    if (spring.up_to < s) continue;
                    double bent = 0.0;
                    for (int k = 0; k <= spring.up_to; ++k) bent += spring.x * b[k][0] + spring.y * b[k][1];
                    if (bent >= spring.pulled) continue;
                    const double along = a == 0 ? spring.x : spring.y;
                    pull += along * (spring.pulled - bent);
                    stiff += along * along;
                }
                b[s][a] += pull / stiff;
            }
    return b;
}

}  // namespace

std::unique_ptr<Folder> record_tendons(const Recipe& r) {
    constexpr int runs = 4, fine = 10;
    constexpr double dt = 0.1, noise = 0.3, radius = 4.0;
    constexpr double first[3] = {20.0, 75.0, -40.0}, gain[3] = {0.9, 1.0, 0.95};
    std::mt19937_64 random(r.seed * 32452843 + 17);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const double size = r.strength;
    const auto acts = [&](const char* effect) { return acts_in(r, effect); };
    std::ostringstream csv;
    csv.precision(9);
    csv << "run,t_s";
    for (int k = 1; k <= 9; ++k) csv << ",l" << k << "_mm";
    csv << ",tip_x_mm,tip_y_mm,tip_z_mm\n";
    for (int run = 0; run < runs; ++run) {
        std::vector<Command> command;
        for (int k = 0; k < 6; ++k) command.emplace_back(random, 0.0, k < 2 ? 45.0 : 65.0);
        const int rows = r.rows / runs;
        std::array<B, 3> at{}, lagged{}, memory{}, last{};
        std::vector<std::array<B, 3>> plays(5);
        std::vector<V> seen;
        const auto wanted_at = [&](double t) {
            std::array<B, 3> out;
            for (int s = 0; s < 3; ++s) out[s] = {command[2 * s](t) * rad, command[2 * s + 1](t) * rad};
            return out;
        };
        at = lagged = memory = last = wanted_at(0.0);
        for (auto& p : plays) p = at;
        const auto drag = [](const B& in, double play, B& out) {
            const double x = in[0] - out[0], y = in[1] - out[1], n = std::hypot(x, y);
            if (n > play) out = {in[0] - play / n * x, in[1] - play / n * y};
        };
        for (int i = 0; i < rows * fine; ++i) {
            const double t = i * dt / fine;
            const std::array<B, 3> wanted = wanted_at(t);
            std::array<B, 3> q = wanted;
            for (int s = 0; s < 3; ++s) {
                if (acts("backlash")) {
                    drag(wanted[s], 3.0 * size * rad, at[s]);
                    q[s] = at[s];
                } else if (acts("hysteresis")) {
                    B mean{};
                    for (std::size_t k = 0; k < plays.size(); ++k) {
                        drag(wanted[s], 5.0 * (static_cast<double>(k) + 1.0) * rad, plays[k][s]);
                        for (int a = 0; a < 2; ++a) mean[a] += 0.2 * plays[k][s][a];
                    }
                    for (int a = 0; a < 2; ++a) q[s][a] += 0.2 * size * (mean[a] - wanted[s][a]);
                } else if (acts("actuation-lag")) {
                    for (int a = 0; a < 2; ++a)
                        lagged[s][a] += dt / fine / (0.25 * size) * (wanted[s][a] - lagged[s][a]);
                    q[s] = lagged[s];
                } else if (acts("segment-coupling")) {
                    if (s < 2)
                        for (int a = 0; a < 2; ++a) q[s][a] += 0.12 * size * wanted[s + 1][a];
                } else if (acts("rest-memory")) {
                    const double way = std::hypot(wanted[s][0] - last[s][0], wanted[s][1] - last[s][1]) / rad;
                    for (int a = 0; a < 2; ++a) {
                        memory[s][a] += (wanted[s][a] - memory[s][a]) * (1.0 - std::exp(-0.03 * way));
                        q[s][a] += 0.15 * size * (memory[s][a] - wanted[s][a]);
                    }
                }
            }
            if (acts("tendon-routing")) {
                // Springs of segments and of tendons alike; their balance by going round until nothing moves.
                std::array<B, 3> b = wanted;
                for (int round = 0; round < 60; ++round)
                    for (int s = 0; s < 3; ++s)
                        for (int a = 0; a < 2; ++a) {
                            double pull = 0.0;
                            for (int m = s; m < 3; ++m) {
                                pull += 2.0 * wanted[m][a];
                                for (int before = 0; before <= m; ++before) pull -= before == s ? 0.0 : b[before][a];
                            }
                            b[s][a] = pull / (1.0 + (3 - s));
                        }
                for (int s = 0; s < 3; ++s)
                    for (int a = 0; a < 2; ++a) q[s][a] += 0.35 * size * (b[s][a] - wanted[s][a]);
            }
            if (acts("tendon-stretch") && i % fine == 0) {
                const std::array<B, 3> b = springs_at_rest(wanted, first, 0.4, 0.05);
                for (int s = 0; s < 3; ++s)
                    for (int a = 0; a < 2; ++a) q[s][a] += 0.3 * size * (b[s][a] - wanted[s][a]);
            }
            last = wanted;
            if (acts("sensor-latency")) seen.push_back(robot_tip(q, 0.0));
            if (i % fine != 0) continue;
            V tip = acts("sensor-latency") ? V{} : robot_tip(q, acts("curvature-taper") ? -0.35 * size : 0.0);
            if (acts("sensor-latency")) {
                const auto back = static_cast<std::size_t>(20.0 * size);
                tip = seen[seen.size() > back ? seen.size() - 1 - back : 0];
            }
            if (acts("field-distortion")) distort(size, tip);
            if (acts("sensor-drift")) {
                tip[0] += 3.5 * size * t / 60.0;
                tip[1] -= 2.5 * size * t / 60.0;
            }
            if (acts("vibration")) tip[0] += 0.9 * size * std::sin(2.0 * pi * t / 0.59);
            if (acts("step") && run == 2 && i > rows * fine / 2) {
                tip[0] += 2.5 * size;
                tip[2] -= 2.0 * size;
            }
            if (acts("outliers") && uniform(random) < 0.03)
                for (double& x : tip) x += 8.0 * size * normal(random);
            csv << run << "," << t;
            for (int s = 0; s < 3; ++s)
                for (int k = 0; k < 3; ++k) {
                    const double place = (first[s] + 120.0 * k) * rad;
                    csv << "," << radius / gain[s] * (wanted[s][0] * std::cos(place) + wanted[s][1] * std::sin(place));
                }
            for (const double x : tip) csv << "," << x + noise * normal(random);
            csv << "\n";
        }
    }
    std::string toml =
        "format = 1\nkind = \"tendon-tip\"\ntitle = \"made\"\nsource = \"made by a test\"\nlicense = \"none\"\n"
        "declared_effects = []\nsensor_noise = 0.3\n[setup]\ntendon_radius_mm = 4.0\n";
    for (int s = 0; s < 3; ++s) {
        toml += "[[setup.segment]]\nname = \"s" + std::to_string(s) + "\"\nlength_mm = 40.0\ntendons = [";
        for (int k = 1; k <= 3; ++k)
            toml += std::string(k > 1 ? ", " : "") + "\"l" + std::to_string(3 * s + k) + "_mm\"";
        toml += "]\n";
    }
    return std::make_unique<Folder>(toml, csv.str());
}

}  // namespace explain_test
