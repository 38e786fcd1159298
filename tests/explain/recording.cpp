#include "explain/recording.h"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

namespace explain_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double rad = pi / 180.0;

using V = std::array<double, 3>;
using M = std::array<V, 3>;  // columns

M identity() {
    return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}
V times(const M& m, const V& v) {
    V out{};
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j) out[k] += m[j][k] * v[j];
    return out;
}
M times(const M& a, const M& b) {
    return {times(a, b[0]), times(a, b[1]), times(a, b[2])};
}
M about(int axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    M out = identity();
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    out[i][i] = c;
    out[i][j] = s;
    out[j][i] = -s;
    out[j][j] = c;
    return out;
}
void go(V& at, const M& frame, double ahead) {
    for (int k = 0; k < 3; ++k) at[k] += ahead * frame[2][k];
}

/// Smooth random commands: a sum of sines with seeded phases, and halts in between.
class Command {
public:
    Command(std::mt19937_64& random, double middle, double reach) : middle_(middle), reach_(reach) {
        std::uniform_real_distribution<double> phase(0.0, 2.0 * pi), period(7.0, 31.0);
        for (int k = 0; k < 3; ++k) parts_.push_back({period(random), phase(random)});
    }
    double operator()(double t) const {
        double sum = 0.0;
        for (const auto& [period, phase] : parts_) sum += std::sin(2.0 * pi * t / period + phase);
        return middle_ + reach_ * sum / 3.0;
    }

private:
    double middle_, reach_;
    std::vector<std::array<double, 2>> parts_;
};

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

/// Moves only when pushed by either edge of a gap.
void through_gap(double gap, double wanted, double& at) {
    if (wanted - at > 0.5 * gap) at = wanted - 0.5 * gap;
    if (at - wanted > 0.5 * gap) at = wanted + 0.5 * gap;
}

double breath(double turn) {
    const double s = std::sin(pi * turn);
    return s * s * s * s;
}

/// Readings that go wrong with the square of the distance from the tracker.
void distort(double size, V& tip) {
    const double square = (tip[0] * tip[0] + tip[1] * tip[1] + tip[2] * tip[2]) / 1e4;
    tip[0] += 1.2 * size * square;
    tip[1] -= 1.8 * size * square;
    tip[2] += 0.6 * size * square;
}

std::unique_ptr<Folder> record_catheter(const Recipe& r) {
    constexpr int runs = 4;
    constexpr double dt = 0.1, noise = 0.3;
    std::mt19937_64 random(r.seed * 7919 + 13);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const V down{0.0, -1.0, 0.0};
    const double size = r.strength;
    const std::string& e = r.effect;
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
        const double turn = uniform(random), taper = e == "curvature-taper" ? -0.35 * size : 0.0;
        double twisted = rotation(0.0);
        for (int i = 0; i < rows * fine; ++i) {
            const double t = i * dt / fine;
            const Joint wanted{insertion(t), rotation(t), proximal(t), distal(t)};
            Joint q = wanted;
            double sag = 0.0;
            if (e == "backlash") {
                through_gap(5.0 * size, wanted.proximal, at.proximal);
                through_gap(6.0 * size, wanted.distal, at.distal);
                q.proximal = at.proximal;
                q.distal = at.distal;
            } else if (e == "hysteresis") {
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
            } else if (e == "actuation-lag") {
                const double k = dt / fine / (0.25 * size);
                lagged.proximal += k * (wanted.proximal - lagged.proximal);
                lagged.distal += k * (wanted.distal - lagged.distal);
                q.proximal = lagged.proximal;
                q.distal = lagged.distal;
            } else if (e == "segment-coupling") {
                q.proximal += 0.12 * size * wanted.distal;
            } else if (e == "actuation-gain") {
                q.proximal *= 1.0 - 0.06 * size;
                q.distal *= 1.0 + 0.05 * size;
            } else if (e == "gravity-sag") {
                sag = 2.5 * size;
            } else if (e == "rest-memory") {
                const auto remember = [&](double now, double last, double& kept) {
                    kept += (now - kept) * (1.0 - std::exp(-0.03 * std::fabs(now - last)));
                };
                remember(wanted.proximal, before.proximal, memory.proximal);
                remember(wanted.distal, before.distal, memory.distal);
                q.proximal += 0.15 * size * (memory.proximal - wanted.proximal);
                q.distal += 0.15 * size * (memory.distal - wanted.distal);
            } else if (e == "torsion-windup") {
                const double slack = (3.0 + 0.08 * wanted.insertion) * size;  // deg to either side
                if (wanted.rotation - twisted > slack) twisted = wanted.rotation - slack;
                if (twisted - wanted.rotation > slack) twisted = wanted.rotation + slack;
                q.rotation = twisted;
            } else if (e == "grip-slip") {
                if (run == 1 && i > rows * fine * 3 / 5) q.insertion -= 4.0 * size;
            }
            before = wanted;
            if (i % fine != 0) {
                if (e == "sensor-latency") seen.push_back(tip_of(q, sag, down));
                continue;
            }
            V tip = tip_of(q, sag, down, taper);
            if (e == "sensor-latency") {
                seen.push_back(tip);
                const auto back = static_cast<std::size_t>(20.0 * size);  // hundredths of a second
                tip = seen[seen.size() > back ? seen.size() - 1 - back : 0];
            } else if (e == "registration") {
                tip = times(times(about(0, 0.8 * size * rad), about(2, 0.5 * size * rad)), tip);
                tip[0] += 0.9 * size;
                tip[2] -= 0.6 * size;
            } else if (e == "field-distortion") {
                distort(size, tip);
            } else if (e == "sensor-drift") {
                tip[0] += 3.5 * size * t / 60.0;
                tip[1] -= 2.5 * size * t / 60.0;
            } else if (e == "respiration") {
                const double b = 2.0 * size * breath(t / 4.1 + turn);
                tip[1] += 0.3 * b;
                tip[2] -= 0.95 * b;
            } else if (e == "vibration") {
                tip[0] += 0.9 * size * std::sin(2.0 * pi * t / 0.59);
            } else if (e == "step") {
                if (run == 2 && i > rows * fine / 2) {
                    tip[0] += 2.5 * size;
                    tip[2] -= 2.0 * size;
                }
            } else if (e == "outliers") {
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

/// A beat that begins at rest, falls in systole and comes back.
double beat(double phase) {
    return -5.0 * std::pow(std::sin(pi * phase), 2) - 1.5 * std::sin(2.0 * pi * phase) * std::sin(pi * phase);
}

std::unique_ptr<Folder> record_heart(const Recipe& r) {
    constexpr int runs = 2;
    constexpr double dt = 0.04, noise = 0.12, usual = 0.87;
    std::mt19937_64 random(r.seed * 104729 + 7);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const double size = r.strength;
    const std::string& e = r.effect;
    std::ostringstream csv, beats;
    csv.precision(9);
    csv << "run,t_s,displacement_mm\n";
    beats.precision(9);
    for (int run = 0; run < runs; ++run) {
        const int rows = r.rows / runs;
        const double length = rows * dt, turn = uniform(random);
        // True beginnings of the beats; the recorded ones are the same but for a rate that nobody noticed.
        std::vector<double> start{0.0};
        std::vector<double> before{usual};
        while (start.back() < length + 2.0) {
            double interval = usual;
            if (e == "ectopic-beats") {
                if (start.size() % 7 == 4) interval = 0.62 * usual;
                if (start.size() % 7 == 5) interval = 1.38 * usual;
            }
            before.push_back(interval);
            start.push_back(start.back() + interval);
        }
        beats << (run > 0 ? ", [" : "[");
        for (std::size_t k = 0; k < start.size(); ++k) beats << (k > 0 ? ", " : "") << start[k];
        beats << "]";
        std::size_t n = 0;
        double shift = 0.0;  // of the phase, beats
        for (int i = 0; i < rows; ++i) {
            const double t = i * dt;
            while (start[n + 1] <= t) ++n;
            double phase = (t - start[n]) / (start[n + 1] - start[n]);
            double factor = 1.0, more = 0.0;
            if (e == "alternans") factor = 1.0 + (n % 2 == 0 ? 0.07 : -0.07) * size;
            if (e == "amplitude-drift") factor = 1.0 - 0.35 * size * t / 60.0;
            if (e == "ectopic-beats") factor = 1.0 + 0.5 * size * (before[n] / usual - 1.0);
            if (e == "rate-variability") {
                const double period = 9.0;
                shift = 0.02 * size * period / usual / (2.0 * pi) *
                        (std::cos(2.0 * pi * turn) - std::cos(2.0 * pi * (t / period + turn)));
                phase += shift;
            }
            if (e == "respiration") more = 0.9 * size * breath(t / 4.3 + turn);
            if (e == "baseline-wander") more = 0.5 * size * std::sin(2.0 * pi * (t / 13.0 + turn));
            if (e == "sensor-drift") more = 2.0 * size * t / 60.0;
            if (e == "vibration") more = 0.4 * size * std::sin(2.0 * pi * t / 0.31);
            if (e == "step" && run == 1 && 2 * i > rows) more = 1.0 * size;
            if (e == "outliers" && uniform(random) < 0.03) more = 3.0 * size * normal(random);
            csv << run << "," << t << ","
                << 10.0 * run + factor * beat(phase - std::floor(phase)) + more + noise * normal(random) << "\n";
        }
    }
    return std::make_unique<Folder>(heart_toml("[" + beats.str() + "]", "0.12"), csv.str());
}

/// The stretch at which a force that rises with it is the wanted one.
template <class F>
double stretch_of(const F& force, double wanted) {
    double low = 0.5, high = 3.0;
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (force(middle) > wanted ? high : low) = middle;
    }
    return 0.5 * (low + high);
}

/// A strip that is pulled in rising cycles with halts.  Even seeds are of rubber that keeps its volume, odd ones of a
/// straight line.
std::unique_ptr<Folder> record_tension(const Recipe& r) {
    constexpr int runs = 4, fine = 10;
    constexpr double dt = 0.25, noise = 0.0012, modulus = 420.0;
    std::mt19937_64 random(r.seed * 15485863 + 3);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const double size = r.strength;
    const std::string& e = r.effect;
    const bool rubber = r.seed % 2 == 0;
    const auto elastic = [&](double l) {
        const double line = rubber ? modulus / 3.0 * (l - 1.0 / (l * l)) : modulus * (l - 1.0);
        return e == "stiffening" ? line + 2200.0 * size * std::pow(std::max(0.0, l - 1.0), 3) : line;
    };
    const auto energy = [&](double l) {
        return rubber ? modulus / 6.0 * (l * l + 2.0 / l - 3.0) : 0.5 * modulus * (l - 1.0) * (l - 1.0);
    };
    std::ostringstream csv;
    csv.precision(9);
    csv << "run,t_s,stress_kpa,strain\n";
    for (int run = 0; run < runs; ++run) {
        const int rows = r.rows / runs;
        const double cycle = 6.0 + 4.0 * uniform(random), top = 60.0 + 50.0 * uniform(random);
        double over = 0.0, before = 0.0, most = 0.0, crept = 0.0, gripped = 0.0;
        for (int i = 0; i < rows * fine; ++i) {
            const double t = i * dt / fine, h = dt / fine;
            const int number = static_cast<int>(t / cycle);
            const double place = t / cycle - number;
            // Up in a third, held for a third, down in the last.
            const double shape = place < 1.0 / 3 ? 3.0 * place : (place < 2.0 / 3 ? 1.0 : 3.0 * (1.0 - place));
            const double stress = top * (0.4 + 0.2 * std::min(number, 4)) * shape;
            double strain = 0.0;
            if (e == "viscoelasticity") {
                // A Maxwell element beside the elastic strip, taken implicitly.
                const double g = 0.35 * size, theta = 1.5;
                const auto force = [&](double l) {
                    return elastic(l) + (over + g * (elastic(l) - before)) / (1.0 + h / theta);
                };
                const double l = stretch_of(force, stress);
                over = (over + g * (elastic(l) - before)) / (1.0 + h / theta);
                before = elastic(l);
                strain = l - 1.0;
            } else if (e == "softening") {
                const auto force = [&](double l) {
                    const double w = energy(l);
                    return elastic(l) *
                           (w < most ? 1.0 - 0.22 * size * std::tanh(1.3 * (most - w) / (0.5 * most)) : 1.0);
                };
                const double l = stretch_of(force, stress);
                most = std::max(most, energy(l));
                strain = l - 1.0;
            } else {
                strain = stretch_of(elastic, stress) - 1.0;
            }
            if (e == "slack") strain += 0.02 * size * std::min(1.0, stress / 0.5);
            if (e == "creep") {
                const double c = 0.04 * size;
                if (strain > 1e-6) crept += h * c * strain / 0.5 * std::exp(-std::min(40.0, crept / (c * strain)));
                strain += crept;
            }
            if (e == "boundary-slip") {
                const double give = 1.2e-4 * size, hold = 15.0;  // strain a kPa, kPa
                if (stress - gripped / give > hold) gripped = give * (stress - hold);
                if (stress - gripped / give < -hold) gripped = give * (stress + hold);
                strain += gripped;
            }
            if (i % fine != 0) continue;
            if (e == "vibration") strain += 0.004 * size * std::sin(2.0 * pi * t / 0.83);
            if (e == "step" && run == 2 && 2 * i > rows * fine) strain += 0.012 * size;
            if (e == "outliers" && uniform(random) < 0.03) strain += 0.03 * size * normal(random);
            csv << run << "," << t << "," << stress << "," << strain + noise * normal(random) << "\n";
        }
    }
    return std::make_unique<Folder>(
        "format = 1\nkind = \"wall-tension\"\ntitle = \"made\"\nsource = \"made by a test\"\nlicense = \"none\"\n"
        "declared_effects = []\nsensor_noise = 0.0012\n[setup]\nspecimen = \"strip\"\nthickness_mm = 1.0\n"
        "mode = \"tension\"\n",
        csv.str());
}

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

std::unique_ptr<Folder> record_tendons(const Recipe& r) {
    constexpr int runs = 4, fine = 10;
    constexpr double dt = 0.1, noise = 0.3, radius = 4.0;
    constexpr double first[3] = {20.0, 75.0, -40.0}, gain[3] = {0.9, 1.0, 0.95};
    std::mt19937_64 random(r.seed * 32452843 + 17);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const double size = r.strength;
    const std::string& e = r.effect;
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
                if (e == "backlash") {
                    drag(wanted[s], 3.0 * size * rad, at[s]);
                    q[s] = at[s];
                } else if (e == "hysteresis") {
                    B mean{};
                    for (std::size_t k = 0; k < plays.size(); ++k) {
                        drag(wanted[s], 5.0 * (static_cast<double>(k) + 1.0) * rad, plays[k][s]);
                        for (int a = 0; a < 2; ++a) mean[a] += 0.2 * plays[k][s][a];
                    }
                    for (int a = 0; a < 2; ++a) q[s][a] += 0.2 * size * (mean[a] - wanted[s][a]);
                } else if (e == "actuation-lag") {
                    for (int a = 0; a < 2; ++a)
                        lagged[s][a] += dt / fine / (0.25 * size) * (wanted[s][a] - lagged[s][a]);
                    q[s] = lagged[s];
                } else if (e == "segment-coupling") {
                    if (s < 2)
                        for (int a = 0; a < 2; ++a) q[s][a] += 0.12 * size * wanted[s + 1][a];
                } else if (e == "rest-memory") {
                    const double way = std::hypot(wanted[s][0] - last[s][0], wanted[s][1] - last[s][1]) / rad;
                    for (int a = 0; a < 2; ++a) {
                        memory[s][a] += (wanted[s][a] - memory[s][a]) * (1.0 - std::exp(-0.03 * way));
                        q[s][a] += 0.15 * size * (memory[s][a] - wanted[s][a]);
                    }
                }
            }
            if (e == "tendon-routing") {
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
            last = wanted;
            if (e == "sensor-latency") seen.push_back(robot_tip(q, 0.0));
            if (i % fine != 0) continue;
            V tip = e == "sensor-latency" ? V{} : robot_tip(q, e == "curvature-taper" ? -0.35 * size : 0.0);
            if (e == "sensor-latency") {
                const auto back = static_cast<std::size_t>(20.0 * size);
                tip = seen[seen.size() > back ? seen.size() - 1 - back : 0];
            }
            if (e == "field-distortion") distort(size, tip);
            if (e == "sensor-drift") {
                tip[0] += 3.5 * size * t / 60.0;
                tip[1] -= 2.5 * size * t / 60.0;
            }
            if (e == "vibration") tip[0] += 0.9 * size * std::sin(2.0 * pi * t / 0.59);
            if (e == "step" && run == 2 && i > rows * fine / 2) {
                tip[0] += 2.5 * size;
                tip[2] -= 2.0 * size;
            }
            if (e == "outliers" && uniform(random) < 0.03)
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

}  // namespace

std::unique_ptr<Folder> record(const Recipe& recipe) {
    if (recipe.kind == "wall-tension") return record_tension(recipe);
    if (recipe.kind == "tendon-tip") return record_tendons(recipe);
    return recipe.kind == "heart-motion" ? record_heart(recipe) : record_catheter(recipe);
}

const std::vector<std::string>& known_effects(const std::string& kind) {
    static const std::vector<std::string> heart{"respiration",     "alternans",        "ectopic-beats",
                                                "amplitude-drift", "rate-variability", "baseline-wander",
                                                "sensor-drift"};
    static const std::vector<std::string> catheter{
        "backlash",     "hysteresis",     "actuation-lag",   "segment-coupling", "actuation-gain",
        "gravity-sag",  "rest-memory",    "respiration",     "sensor-latency",   "registration",
        "sensor-drift", "torsion-windup", "curvature-taper", "field-distortion"};
    static const std::vector<std::string> tension{"stiffening", "viscoelasticity", "softening",
                                                  "slack",      "creep",           "boundary-slip"};
    static const std::vector<std::string> tendons{
        "backlash",    "hysteresis",     "actuation-lag", "segment-coupling", "tendon-routing",
        "rest-memory", "sensor-latency", "sensor-drift",  "curvature-taper",  "field-distortion"};
    if (kind == "wall-tension") return tension;
    if (kind == "tendon-tip") return tendons;
    return kind == "heart-motion" ? heart : catheter;
}

const std::vector<std::string>& foreign_effects(const std::string& kind) {
    static const std::vector<std::string> heart{"vibration", "step", "outliers"};
    static const std::vector<std::string> catheter{"vibration", "step", "outliers", "grip-slip"};
    static const std::vector<std::string> tension{"vibration", "step", "outliers"};
    if (kind == "wall-tension" || kind == "tendon-tip") return tension;
    return kind == "heart-motion" ? heart : catheter;
}

}  // namespace explain_test
