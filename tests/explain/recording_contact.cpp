// A tube that a ball is pushed into from inside, by a finite-element model of its own (tube_shell.h).
#include <algorithm>
#include <sstream>

#include "explain/recording.h"
#include "explain/recording_parts.h"
#include "explain/tube_shell.h"

namespace explain_test {
namespace {

/// Rubber in plane stress that keeps its volume.
Vector3d rubber(double mu, const Vector3d& e, double* energy = nullptr) {
    const double c11 = 1.0 + 2.0 * e[0], c22 = 1.0 + 2.0 * e[1], c12 = 2.0 * e[2];
    const double d = c11 * c22 - c12 * c12;
    if (energy != nullptr) *energy = 0.5 * mu * (c11 + c22 + 1.0 / d - 3.0);
    return mu * Vector3d(1.0 - c22 / (d * d), 1.0 - c11 / (d * d), c12 / (d * d));
}

/// What a layer of the wall does with one effect (or two) in it.
class Wall {
public:
    Wall(const Recipe& r, double young_kpa) : mu_(young_kpa / 3.0), size_(r.strength) {
        collagen_ = acts_in(r, "stiffening");
        relaxes_ = acts_in(r, "viscoelasticity");
        creeps_ = acts_in(r, "creep");
        softens_ = acts_in(r, "softening");
        hangs_ = acts_in(r, "slack");
    }
    double dt = 0.0;  ///< since the sample before

    Vector3d operator()(const Vector3d& green, LayerMemory& memory, bool keep) const {
        Vector3d e = green;
        if (hangs_) e -= folds(e);
        Eigen::Map<Vector3d> before(memory.data()), late(memory.data() + 3);
        if (creeps_) {
            e -= late;
            if (keep) flow(e, late);
        }
        double energy = 0.0;
        Vector3d stress = rubber(mu_, e, &energy);
        if (softens_) {
            // It gives way below the most that it has borne.
            double& most = memory[6];
            if (energy < most) stress *= 1.0 - 0.25 * size_ * std::tanh(2.0 * (most - energy) / most);
            if (keep) most = std::max(most, energy);
        }
        if (collagen_) stress += fibres(e);
        if (relaxes_) {
            // A spring and a dashpot in a row beside it, both straight; the strain goes straight between samples.
            const double share = 0.35 * size_, theta = 2.0, x = dt / theta;
            const double kept = std::exp(-x), at_once = x > 0.0 ? (1.0 - kept) / x : 1.0;
            const Vector3d over = dt > 0.0 ? Vector3d(kept * (before - late) + at_once * (e - before)) : e;
            stress +=
                share * mu_ * Vector3d(4.0 * over[0] + 2.0 * over[1], 4.0 * over[1] + 2.0 * over[0], 2.0 * over[2]);
            if (keep) {
                before = e;
                late = e - over;
            }
        }
        return stress;
    }

private:
    /// Of each main strain so much bears little, with round corners: folds do not all open at once.
    Vector3d folds(const Vector3d& e) const {
        const double loose = 0.025 * size_, middle = 0.5 * (e[0] + e[1]), half = 0.5 * (e[0] - e[1]);
        const double apart = std::max(std::hypot(half, e[2]), 1e-9);
        const auto taken = [&](double strain) {
            const double y = strain / loose, round = 0.2;
            const auto open = [&](double x) { return 0.5 * (std::hypot(x, round) - std::hypot(1.0 - x, round)); };
            return 0.9 * loose * (open(y) - open(0.0));
        };
        const double high = taken(middle + apart), low = taken(middle - apart);
        const double mean = 0.5 * (high + low), slope = 0.5 * (high - low) / apart;
        return {mean + slope * half, mean - slope * half, slope * e[2]};
    }
    /// It flows the way it is strained, ever more slowly.
    void flow(const Vector3d& e, Eigen::Map<Vector3d>& flowed) const {
        constexpr int parts = 20;
        const double c = 0.06 * size_, start = 0.5;
        const auto length = [](const Vector3d& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + 2.0 * v[2] * v[2]); };
        const double strained = length(e);
        if (!(strained > 1e-7)) return;
        for (int k = 0; k < parts; ++k)
            flowed += dt / parts * c / start * std::exp(-std::min(40.0, length(flowed) / (c * strained))) * e;
    }
    /// Collagen in six directions, crimped until it is drawn, then ever stiffer.
    Vector3d fibres(const Vector3d& e) const {
        Vector3d out = Vector3d::Zero();
        for (int k = 0; k < 6; ++k) {
            const double c = std::cos(k * pi / 6.0), s = std::sin(k * pi / 6.0);
            const double drawn = 2.0 * (c * c * e[0] + s * s * e[1] + 2.0 * c * s * e[2]) - 0.04;
            if (drawn > 0.0)
                out += 0.5 * mu_ * size_ * drawn * std::exp(4.0 * drawn * drawn) * Vector3d(c * c, s * s, c * s);
        }
        return out;
    }

    double mu_, size_;
    bool collagen_, relaxes_, creeps_, softens_, hangs_;
};

/// How deep the ball is pushed, straight between times (both of the whole).
using Course = std::vector<std::pair<double, double>>;

double depth_at(const Course& course, double part) {
    for (std::size_t k = 1; k < course.size(); ++k) {
        const auto& [from, low] = course[k - 1];
        const auto& [to, high] = course[k];
        if (part <= to) return low + (high - low) * (part - from) / (to - from);
    }
    return course.back().second;
}

/// A run: how long, how deep when, and how far along the tube.
struct Push {
    double seconds, place;
    Course course;
};

const std::vector<Push>& pushes() {
    static const std::vector<Push> all{
        // Quick, a long hold, and a look at what stays behind.
        {16.0, 0.5, {{0.0, 0.0}, {0.12, 1.0}, {0.62, 1.0}, {0.74, 0.0}, {1.0, 0.0}}},
        // In stairs, down by one.
        {24.0, 0.34, {{0.0, 0.0}, {0.1, 0.45}, {0.3, 0.45}, {0.4, 1.0}, {0.65, 1.0}, {0.75, 0.5}, {1.0, 0.5}}},
        // Slow, twice, the second time deeper, not far from an end.
        {30.0, 0.17, {{0.0, 0.0}, {0.2, 0.6}, {0.4, 0.1}, {0.65, 1.0}, {0.9, 0.1}, {1.0, 0.1}}},
        // Very quick, deep at once, then shallow for long.
        {12.0, 0.62, {{0.0, 0.0}, {0.08, 1.0}, {0.3, 1.0}, {0.38, 0.4}, {1.0, 0.4}}}};
    return all;
}

}  // namespace

std::unique_ptr<Folder> record_contact(const Recipe& r) {
    constexpr double noise = 0.1, noise_n = 0.001;
    std::mt19937_64 random(r.seed * 49979687 + 11);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const double size = r.strength;
    const auto acts = [&](const char* effect) { return acts_in(r, effect); };
    TubeRig rig;
    rig.lumen_radius_mm = 12.0 + 2.0 * uniform(random);
    rig.thickness_mm = 1.2 + 0.4 * uniform(random);
    const double young = 500.0 + 400.0 * uniform(random);
    rig.bed_kpa_per_mm = young / (0.75 * rig.thickness_mm);
    if (acts("tissue-support")) rig.support_kpa_per_mm = 0.5 * size;
    if (acts("boundary-slip")) rig.edge = {true, 4.0, 1.0 / (0.08 * size)};
    std::ostringstream csv, rest;
    csv.precision(9);
    rest.precision(9);
    csv << "run,t_s,tool_x_mm,tool_y_mm,tool_z_mm,sensor_x_mm,sensor_y_mm,sensor_z_mm,force_n\n";
    const int rows = r.rows / static_cast<int>(pushes().size());
    const M tracker = times(about(2, 1.2 * size * rad), about(0, -0.7 * size * rad));
    for (std::size_t run = 0; run < pushes().size(); ++run) {
        const Push& push = pushes()[run];
        const double angle = 2.0 * pi * uniform(random), z = push.place * rig.length_mm;
        const double deep = 5.0 + 2.0 * uniform(random), aslant = 0.15 * (uniform(random) - 0.5);
        const double aside = (run % 2 == 0 ? 1.0 : -1.0) * (0.35 + 0.2 * uniform(random));
        const double ahead = (z < 0.5 * rig.length_mm ? 1.0 : -1.0) * (5.0 + 4.0 * uniform(random));
        Wall wall(r, young);
        rig.law = [&wall](const Vector3d& e, LayerMemory& memory, bool keep) { return wall(e, memory, keep); };
        TubeShell tube(rig, angle, z);
        const Vector3d out(std::cos(angle), std::sin(angle), 0.0);
        const Vector3d way = (out + aslant * Vector3d::UnitZ()).normalized();
        const Vector3d start = (rig.lumen_radius_mm - rig.ball_radius_mm) * out + z * Vector3d::UnitZ();
        const Vector3d marker = tube.outside(angle + aside, z + ahead);
        rest << (run > 0 ? ", [" : "[") << marker[0] << ", " << marker[1] << ", " << marker[2] << "]";
        const double dt = push.seconds / (rows - 1), late = 0.5 * size;
        const Vector3d jolt = Vector3d(0.6, -0.5, 0.7) * size;
        std::vector<Vector3d> seen;
        for (int i = 0; i < rows; ++i) {
            const double t = i * dt;
            const Vector3d told = start + deep * depth_at(push.course, i / (rows - 1.0)) * way;
            Vector3d tool = told;
            // The ball has slipped in what holds it.
            if (acts("grip-slip") && run >= 1 && 3 * i > rows) tool -= 1.0 * size * way;
            wall.dt = i > 0 ? dt : 0.0;
            const double force = tube.press(tool).dot(way);
            seen.push_back(tube.outside(angle + aside, z + ahead));
            Vector3d read = seen.back();
            if (acts("sensor-latency")) {
                const double back = std::min(static_cast<double>(i), late / dt);
                const auto whole = static_cast<std::size_t>(back);
                const Vector3d &a = seen[seen.size() - 1 - whole],
                               &b = seen[seen.size() - 1 - std::min(whole + 1, seen.size() - 1)];
                read = a + (back - static_cast<double>(whole)) * (b - a);
            }
            V at{read[0], read[1], read[2]};
            if (acts("registration")) at = times(tracker, V{at[0] + 0.3 * size, at[1], at[2] - 0.4 * size});
            if (acts("sensor-drift")) at = {at[0] + 1.2 * size * t / 60.0, at[1], at[2] - 1.6 * size * t / 60.0};
            for (std::size_t k = 0; k < 3; ++k) {
                const auto axis = static_cast<Eigen::Index>(k);
                if (acts("vibration")) at[k] += 0.6 * jolt[axis] * std::sin(2.0 * pi * t / 3.1);
                if (acts("step") && run == 2 && 2 * i > rows) at[k] += jolt[axis];
            }
            if (acts("outliers") && uniform(random) < 0.05)
                for (double& p : at) p += 1.5 * size * normal(random);
            csv << run << "," << t << "," << told[0] << "," << told[1] << "," << told[2];
            for (const double p : at) csv << "," << p + noise * normal(random);
            csv << "," << 1e-3 * force + noise_n * normal(random) << "\n";
        }
    }
    std::ostringstream toml;
    toml.precision(9);
    toml << "format = 1\nkind = \"wall-contact\"\ntitle = \"made\"\nsource = \"made by a test\"\nlicense = \"none\"\n"
            "declared_effects = []\nsensor_noise = "
         << noise << "\n[setup]\ntube = { radius_mm = " << rig.lumen_radius_mm << ", length_mm = " << rig.length_mm
         << ", thickness_mm = " << rig.thickness_mm << " }\ntool_radius_mm = " << rig.ball_radius_mm
         << "\nsensor_rest_mm = [" << rest.str() << "]\nmaterial = { law = \"neo-hooke\", young_modulus_kpa = " << young
         << ", poisson = 0.49 }\ndensity_kg_m3 = 1100.0\n";
    for (const auto& [name, end] : {std::pair{"start", 0.0}, std::pair{"end", rig.length_mm}})
        toml << "[[setup.fixed]]\nname = \"" << name << "\"\ncenter_mm = [0.0, 0.0, " << end
             << "]\nnormal = [0.0, 0.0, 1.0]\nradius_mm = " << rig.lumen_radius_mm + rig.thickness_mm + 0.5
             << "\nhalf_thickness_mm = 0.1\n";
    return std::make_unique<Folder>(toml.str(), csv.str());
}

}  // namespace explain_test
