// A steerable catheter's tip by a kinematics of its own.
#include <sstream>

#include "explain/recording_parts.h"

namespace explain_test {
namespace {

struct Joint {
    double insertion, rotation, proximal, distal;  // mm, deg
};

/// Segments cut into many short straight pieces: no closed form of an arc is used.
V tip_of(const Joint& q, double sag_drop, const V& down, double taper = 0.0) {
    constexpr int pieces = 40;
    constexpr double lengths[2] = {25.0, 30.0}, middle = 4.0, end = 2.0;
    const double bends[2] = {q.proximal * rad, q.distal * rad};
    const double all = lengths[0] + middle + lengths[1] + end;
    const double load = 8.0 * sag_drop / (all * all * all * all);
    struct Piece {
        double length;
        double turn;
        bool soft;
    };
    std::vector<Piece> chain;
    for (int segment = 0; segment < 2; ++segment) {
        for (int k = 0; k < pieces; ++k) {
            const double uneven = 1.0 + taper * ((k + 0.5) / pieces * 2.0 - 1.0);
            chain.push_back({lengths[segment] / pieces, uneven * bends[segment] / pieces, true});
        }
        chain.push_back({segment == 0 ? middle : end, 0.0, false});
    }
    // Where all lies without its weight, for the lever of what is beyond each piece.
    const auto lay = [&](const std::vector<V>* moments) {
        std::vector<V> out;
        V at{0.0, 0.0, q.insertion};
        M frame = about(2, q.rotation * rad);
        for (std::size_t k = 0; k < chain.size(); ++k) {
            const auto half = [&] {
                frame = times(frame, about(1, 0.5 * chain[k].turn));
                if (moments == nullptr || !chain[k].soft) return;
                V local{};
                for (int i = 0; i < 3; ++i)
                    for (int j = 0; j < 3; ++j) local[i] += frame[i][j] * (*moments)[k][j];
                const double part = 0.5 * chain[k].length;
                frame = times(times(frame, about(0, part * local[0])), about(1, part * local[1]));
            };
            half();
            go(at, frame, 0.5 * chain[k].length);
            out.push_back(at);
            go(at, frame, 0.5 * chain[k].length);
            half();
        }
        out.push_back(at);
        return out;
    };
    const std::vector<V> straight = lay(nullptr);
    if (sag_drop == 0.0) return straight.back();
    std::vector<V> moments(chain.size(), V{});
    for (std::size_t k = 0; k < chain.size(); ++k)
        for (std::size_t j = k + 1; j < chain.size(); ++j) {
            V arm;
            for (int i = 0; i < 3; ++i) arm[i] = straight[j][i] - straight[k][i];
            const double w = load * chain[j].length;
            moments[k][0] += w * (arm[1] * down[2] - arm[2] * down[1]);
            moments[k][1] += w * (arm[2] * down[0] - arm[0] * down[2]);
            moments[k][2] += w * (arm[0] * down[1] - arm[1] * down[0]);
        }
    return lay(&moments).back();
}

}  // namespace

std::unique_ptr<Folder> record_catheter(const Recipe& r) {
    constexpr int runs = 4;
    constexpr double dt = 0.1, noise = 0.3;
    std::mt19937_64 random(r.seed * 7919 + 13);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const V down{0.0, -1.0, 0.0};
    const double size = r.strength;
    const auto acts = [&](const char* effect) { return acts_in(r, effect); };
    std::ostringstream csv;
    csv.precision(9);
    csv << "run,t_s,insertion_mm,rotation_deg,proximal_bend_deg,distal_bend_deg,tip_x_mm,tip_y_mm,tip_z_mm\n";
    for (int run = 0; run < runs; ++run) {
        const Command insertion(random, 40.0, 35.0), rotation(random, 0.0, 150.0), proximal(random, 20.0, 45.0),
            distal(random, 30.0, 90.0);
        const int rows = r.rows / runs;
        // Finer than the rows, so that lags and gaps do not depend on the sampling.
        constexpr int fine = 10;
        Joint at{insertion(0.0), rotation(0.0), proximal(0.0), distal(0.0)}, lagged = at, memory = at, before = at;
        std::vector<std::array<double, 2>> plays(5, {at.proximal, at.distal});
        std::vector<V> seen;
        const double turn = uniform(random), taper = acts("curvature-taper") ? -0.35 * size : 0.0;
        double twisted = rotation(0.0);
        for (int i = 0; i < rows * fine; ++i) {
            const double t = i * dt / fine;
            const Joint wanted{insertion(t), rotation(t), proximal(t), distal(t)};
            Joint q = wanted;
            double sag = 0.0;
            if (acts("backlash")) {
                through_gap(5.0 * size, wanted.proximal, at.proximal);
                through_gap(6.0 * size, wanted.distal, at.distal);
                q.proximal = at.proximal;
                q.distal = at.distal;
            } else if (acts("hysteresis")) {
                double sum[2] = {0.0, 0.0};
                for (std::size_t k = 0; k < plays.size(); ++k) {
                    const double gap = 2.0 * 25.0 * (static_cast<double>(k) + 1.0) / 5.0;
                    through_gap(gap, wanted.proximal, plays[k][0]);
                    through_gap(gap, wanted.distal, plays[k][1]);
                    sum[0] += 0.2 * plays[k][0];
                    sum[1] += 0.2 * plays[k][1];
                }
                const double share = 0.2 * size;
                q.proximal += share * (sum[0] - wanted.proximal);
                q.distal += share * (sum[1] - wanted.distal);
            } else if (acts("actuation-lag")) {
                const double k = dt / fine / (0.25 * size);
                lagged.proximal += k * (wanted.proximal - lagged.proximal);
                lagged.distal += k * (wanted.distal - lagged.distal);
                q.proximal = lagged.proximal;
                q.distal = lagged.distal;
            } else if (acts("segment-coupling")) {
                q.proximal += 0.12 * size * wanted.distal;
            } else if (acts("actuation-gain")) {
                q.proximal *= 1.0 - 0.06 * size;
                q.distal *= 1.0 + 0.05 * size;
            } else if (acts("gravity-sag")) {
                sag = 2.5 * size;
            } else if (acts("rest-memory")) {
                const auto remember = [&](double now, double last, double& kept) {
                    kept += (now - kept) * (1.0 - std::exp(-0.03 * std::fabs(now - last)));
                };
                remember(wanted.proximal, before.proximal, memory.proximal);
                remember(wanted.distal, before.distal, memory.distal);
                q.proximal += 0.15 * size * (memory.proximal - wanted.proximal);
                q.distal += 0.15 * size * (memory.distal - wanted.distal);
            } else if (acts("torsion-windup")) {
                const double slack = (3.0 + 0.08 * wanted.insertion) * size;  // deg to either side
                if (wanted.rotation - twisted > slack) twisted = wanted.rotation - slack;
                if (twisted - wanted.rotation > slack) twisted = wanted.rotation + slack;
                q.rotation = twisted;
            } else if (acts("grip-slip")) {
                if (run == 1 && i > rows * fine * 3 / 5) q.insertion -= 4.0 * size;
            }
            before = wanted;
            if (i % fine != 0) {
                if (acts("sensor-latency")) seen.push_back(tip_of(q, sag, down));
                continue;
            }
            V tip = tip_of(q, sag, down, taper);
            if (acts("sensor-latency")) {
                seen.push_back(tip);
                const auto back = static_cast<std::size_t>(20.0 * size);  // hundredths of a second
                tip = seen[seen.size() > back ? seen.size() - 1 - back : 0];
            } else if (acts("registration")) {
                tip = times(times(about(0, 0.8 * size * rad), about(2, 0.5 * size * rad)), tip);
                tip[0] += 0.9 * size;
                tip[2] -= 0.6 * size;
            } else if (acts("field-distortion")) {
                distort(size, tip);
            } else if (acts("sensor-drift")) {
                tip[0] += 3.5 * size * t / 60.0;
                tip[1] -= 2.5 * size * t / 60.0;
            } else if (acts("respiration")) {
                const double b = 2.0 * size * breath(t / 4.1 + turn);
                tip[1] += 0.3 * b;
                tip[2] -= 0.95 * b;
            } else if (acts("vibration")) {
                tip[0] += 0.9 * size * std::sin(2.0 * pi * t / 0.59);
            } else if (acts("step")) {
                if (run == 2 && i > rows * fine / 2) {
                    tip[0] += 2.5 * size;
                    tip[2] -= 2.0 * size;
                }
            } else if (acts("outliers")) {
                if (uniform(random) < 0.03)
                    for (double& x : tip) x += 8.0 * size * normal(random);
            }
            csv << run << "," << t << "," << wanted.insertion << "," << wanted.rotation << "," << wanted.proximal << ","
                << wanted.distal;
            for (const double x : tip) csv << "," << x + noise * normal(random);
            csv << "\n";
        }
    }
    const std::string toml =
        "format = 1\nkind = \"catheter-tip\"\ntitle = \"made\"\nsource = \"made by a test\"\nlicense = \"none\"\n"
        "declared_effects = []\nsensor_noise = 0.3\n[setup]\nproximal_length_mm = 25\nmiddle_length_mm = 4\n"
        "distal_length_mm = 30\ntip_length_mm = 2\nbase_position_mm = [0, 0, 0]\nbase_axis = [0, 0, 1]\n"
        "bend_plane_axis = [1, 0, 0]\ndown_axis = [0, -1, 0]\n";
    return std::make_unique<Folder>(toml, csv.str());
}

}  // namespace explain_test
