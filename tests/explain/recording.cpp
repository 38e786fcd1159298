// The heart's motion and a strip under tension, and which recordings there are.
#include "explain/recording.h"

#include <sstream>

#include "explain/recording_parts.h"

namespace explain_test {
namespace {

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
    const auto acts = [&](const char* effect) { return acts_in(r, effect); };
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
            if (acts("ectopic-beats")) {
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
            if (acts("alternans")) factor = 1.0 + (n % 2 == 0 ? 0.07 : -0.07) * size;
            if (acts("amplitude-drift")) factor = 1.0 - 0.35 * size * t / 60.0;
            if (acts("ectopic-beats")) factor = 1.0 + 0.5 * size * (before[n] / usual - 1.0);
            if (acts("rate-variability")) {
                const double period = 9.0;
                shift = 0.02 * size * period / usual / (2.0 * pi) *
                        (std::cos(2.0 * pi * turn) - std::cos(2.0 * pi * (t / period + turn)));
                phase += shift;
            }
            if (acts("respiration")) more = 0.9 * size * breath(t / 4.3 + turn);
            if (acts("baseline-wander")) more = 0.5 * size * std::sin(2.0 * pi * (t / 13.0 + turn));
            if (acts("sensor-drift")) more = 2.0 * size * t / 60.0;
            if (acts("regional-motion"))  // every place goes its own way beside the others
                more = (run == 0 ? 0.5 : -0.3) * size * std::sin(2.0 * pi * (phase - 0.1)) +
                       (run == 0 ? -0.2 : 0.45) * size * std::cos(4.0 * pi * phase);
            if (acts("vibration")) more = 0.4 * size * std::sin(2.0 * pi * t / 0.31);
            if (acts("step") && run == 1 && 2 * i > rows) more = 1.0 * size;
            if (acts("outliers") && uniform(random) < 0.03) more = 3.0 * size * normal(random);
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
    const auto acts = [&](const char* effect) { return acts_in(r, effect); };
    const bool rubber = r.seed % 2 == 0;
    const bool stiffens = acts("stiffening");
    const auto elastic = [&](double l) {
        const double line = rubber ? modulus / 3.0 * (l - 1.0 / (l * l)) : modulus * (l - 1.0);
        if (!stiffens) return line;
        // Collagen: crimped until the strain draws it straight, then ever stiffer.
        const double drawn = std::max(0.0, l - 1.05);
        return line + 30.0 * size * std::expm1(45.0 * drawn * drawn);
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
            if (acts("viscoelasticity")) {
                // A Maxwell element beside the elastic strip, taken implicitly.
                const double g = 0.35 * size, theta = 1.5;
                const auto force = [&](double l) {
                    return elastic(l) + (over + g * (elastic(l) - before)) / (1.0 + h / theta);
                };
                const double l = stretch_of(force, stress);
                over = (over + g * (elastic(l) - before)) / (1.0 + h / theta);
                before = elastic(l);
                strain = l - 1.0;
            } else if (acts("softening")) {
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
            if (acts("slack")) strain += 0.02 * size * std::min(1.0, stress / 0.5);
            if (acts("creep")) {
                const double c = 0.04 * size;
                if (strain > 1e-6) crept += h * c * strain / 0.5 * std::exp(-std::min(40.0, crept / (c * strain)));
                strain += crept;
            }
            if (acts("boundary-slip")) {
                const double give = 1.2e-4 * size, hold = 15.0;  // strain a kPa, kPa
                if (stress - gripped / give > hold) gripped = give * (stress - hold);
                if (stress - gripped / give < -hold) gripped = give * (stress + hold);
                strain += gripped;
            }
            if (i % fine != 0) continue;
            if (acts("vibration")) strain += 0.004 * size * std::sin(2.0 * pi * t / 0.83);
            if (acts("step") && run == 2 && 2 * i > rows * fine) strain += 0.012 * size;
            if (acts("outliers") && uniform(random) < 0.03) strain += 0.03 * size * normal(random);
            csv << run << "," << t << "," << stress << "," << strain + noise * normal(random) << "\n";
        }
    }
    return std::make_unique<Folder>(
        "format = 1\nkind = \"wall-tension\"\ntitle = \"made\"\nsource = \"made by a test\"\nlicense = \"none\"\n"
        "declared_effects = []\nsensor_noise = 0.0012\n[setup]\nspecimen = \"strip\"\nthickness_mm = 1.0\n"
        "mode = \"tension\"\n",
        csv.str());
}

}  // namespace

std::unique_ptr<Folder> record(const Recipe& recipe) {
    if (recipe.kind == "wall-tension") return record_tension(recipe);
    if (recipe.kind == "tendon-tip") return record_tendons(recipe);
    if (recipe.kind == "wall-contact") return record_contact(recipe);
    return recipe.kind == "heart-motion" ? record_heart(recipe) : record_catheter(recipe);
}

const std::vector<std::string>& known_effects(const std::string& kind) {
    static const std::vector<std::string> heart{"respiration",     "alternans",        "ectopic-beats",
                                                "amplitude-drift", "rate-variability", "baseline-wander",
                                                "sensor-drift",    "regional-motion"};
    static const std::vector<std::string> catheter{
        "backlash",     "hysteresis",     "actuation-lag",   "segment-coupling", "actuation-gain",
        "gravity-sag",  "rest-memory",    "respiration",     "sensor-latency",   "registration",
        "sensor-drift", "torsion-windup", "curvature-taper", "field-distortion"};
    static const std::vector<std::string> tension{"stiffening", "viscoelasticity", "softening",
                                                  "slack",      "creep",           "boundary-slip"};
    static const std::vector<std::string> tendons{
        "backlash",       "hysteresis",   "actuation-lag",   "segment-coupling", "tendon-routing", "rest-memory",
        "sensor-latency", "sensor-drift", "curvature-taper", "field-distortion", "tendon-stretch"};
    static const std::vector<std::string> contact{"tissue-support", "boundary-slip", "stiffening", "viscoelasticity",
                                                  "creep",          "softening",     "slack",      "registration",
                                                  "sensor-latency", "sensor-drift"};
    if (kind == "wall-tension") return tension;
    if (kind == "tendon-tip") return tendons;
    if (kind == "wall-contact") return contact;
    return kind == "heart-motion" ? heart : catheter;
}

const std::vector<std::string>& effect_pairs(const std::string& kind) {
    static const std::vector<std::string> heart{"respiration+alternans", "ectopic-beats+baseline-wander",
                                                "amplitude-drift+rate-variability"};
    static const std::vector<std::string> catheter{"backlash+respiration", "segment-coupling+sensor-drift",
                                                   "hysteresis+registration", "gravity-sag+field-distortion"};
    static const std::vector<std::string> tension{"viscoelasticity+slack", "softening+boundary-slip"};
    static const std::vector<std::string> tendons{"backlash+sensor-drift", "segment-coupling+field-distortion",
                                                  "rest-memory+curvature-taper"};
    static const std::vector<std::string> contact{"tissue-support+viscoelasticity", "softening+sensor-drift"};
    if (kind == "wall-tension") return tension;
    if (kind == "tendon-tip") return tendons;
    if (kind == "wall-contact") return contact;
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
