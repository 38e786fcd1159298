#include "calibrate/heart_calibration.h"

#include <Eigen/Dense>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/errors.h"
#include "core/range.h"
#include "effects/effect.h"
#include "heart/motion.h"
#include "step/step.h"

namespace cathlab {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double most_mm = 30.0;       // of a knot (heart/motion.cpp)
constexpr int inverse_runs = 5;        // Gauss-Newton steps at most, before the swarm and after it
constexpr double worth_mm = 1e-4;      // a smaller gain ends them
constexpr double share_of_rmse = 0.1;  // beside the error at the peaks
constexpr double decimals = 1e5;       // of a displacement as it is written

struct Stopped {};

using Profile = std::vector<std::array<double, 2>>;

HeartSpec spec_of(const Profile& profile) {
    HeartSpec spec;
    spec.knots.clear();
    for (const auto& [phase, displacement] : profile) spec.knots.push_back({phase, displacement});
    return spec;
}

// The very number that the overlay's text stands for: what was found is what a scene gets.
double as_written(double value) {
    return std::round(value * decimals) / decimals;
}

// Knots where a curve through them misses the target most, one after the other; evenly spaced where none does.
Profile place_knots(const BeatMotion& target, int count) {
    constexpr int grid = 200;
    const auto at = [&](int i) { return static_cast<double>(i) / grid; };
    std::vector<int> places{0, grid / 4, grid / 2, 3 * grid / 4};
    const auto profile_at = [&](const std::vector<int>& chosen) {
        Profile profile;
        for (const int i : chosen) profile.push_back({at(i), as_written(at_phase(target, at(i)))});
        return profile;
    };
    while (static_cast<int>(places.size()) < count) {
        const HeartSpec spec = spec_of(profile_at(places));
        int worst = -1;
        double most = -1.0;
        for (int i = 0; i < grid; ++i) {
            int gap = grid;
            for (const int p : places) gap = std::min({gap, std::abs(p - i), grid - std::abs(p - i)});
            if (gap < 2) continue;
            const double miss = std::fabs(profile(spec, at(i)).displacement_mm - at_phase(target, at(i)));
            const double merit = miss + 1e-6 * gap;  // the widest gap where the curve is met everywhere
            if (merit > most) {
                most = merit;
                worst = i;
            }
        }
        places.insert(std::upper_bound(places.begin(), places.end(), worst), worst);
    }
    return profile_at(places);
}

class Calibration {
public:
    Calibration(const HeartSearch& search, const SceneModels& models) : search_(search), models_(models) {}

    HeartCalibration run() {
        const SceneSpec own = heart_scene(search_.scene);
        out_.first = motion_of(own, search_.swarm.threads);
        out_.reference_first = reference_at(out_.first);
        out_.figures_first = figures_of(out_.first.z_mm, out_.reference_first);
        told();
        best_ = place_knots(search_.target.motion, search_.knots);
        try {
            approach();
            out_.figures_start = figures_of(best_motion_.z_mm, reference_at(best_motion_));
            swarm();
            if (!out_.stopped && !search_.at_peaks) approach();
        } catch (const Stopped&) {
            out_.stopped = true;
        }
        if (best_motion_.z_mm.empty()) throw UserError("stopped before anything was found");
        out_.profile = best_;
        out_.motion = best_motion_;
        out_.reference = reference_at(out_.motion);
        out_.figures = figures_of(out_.motion.z_mm, out_.reference);
        out_.overlay = overlay();
        return std::move(out_);
    }

private:
    AnnulusMotion motion_of(const SceneSpec& scene, int threads) const {
        AnnulusMotion motion = annulus_motion(scene, models_, search_.beats, threads, search_.stop);
        if (search_.stop && search_.stop()) throw Stopped{};
        return motion;
    }
    SceneSpec scene_with(const Profile& profile) const {
        SceneSpec scene = heart_scene(search_.scene);
        scene.heart.profile = profile;
        scene.heart.excursion_mm = 0.0;
        return scene;
    }
    std::vector<double> reference_at(const AnnulusMotion& motion) const {
        std::vector<double> out;
        for (const double phase : motion.phase) out.push_back(at_phase(search_.target.motion, phase));
        return out;
    }
    void told() {
        ++out_.simulations;
        if (search_.on_simulation) search_.on_simulation(out_.simulations);
    }

    double objective(const AnnulusMotion& motion) const {
        const std::vector<double> reference = reference_at(motion);
        const double rmse = figures_of(motion.z_mm, reference).rmse;
        if (!std::isfinite(rmse)) return infinite;
        if (!search_.at_peaks) return rmse;
        double squares = 0.0;
        int peaks = 0;
        for (int beat = 0; beat < search_.beats; ++beat) {
            double low = infinite, high = -infinite, reference_low = infinite, reference_high = -infinite;
            for (std::size_t i = 0; i < motion.beat.size(); ++i) {
                if (static_cast<int>(motion.beat[i]) != beat) continue;
                low = std::min(low, motion.z_mm[i]);
                high = std::max(high, motion.z_mm[i]);
                reference_low = std::min(reference_low, reference[i]);
                reference_high = std::max(reference_high, reference[i]);
            }
            if (!(low <= high)) continue;
            squares +=
                (low - reference_low) * (low - reference_low) + (high - reference_high) * (high - reference_high);
            peaks += 2;
        }
        return std::sqrt(squares / std::max(1, peaks)) + share_of_rmse * rmse;
    }

    void keep(const Profile& profile, AnnulusMotion motion, double value) {
        if (!(value < best_value_)) return;
        best_value_ = value;
        best_ = profile;
        best_motion_ = std::move(motion);
    }

    // Gauss-Newton with the profile's derivatives in place of the annulus': u -= (J^T J + small)^-1 J^T (z - z_ref).
    void approach() {
        Profile profile = best_;
        for (int k = 0; k < inverse_runs; ++k) {
            const double before = best_value_;
            const AnnulusMotion motion = motion_of(scene_with(profile), search_.swarm.threads);
            told();
            keep(profile, motion, objective(motion));
            if (before - best_value_ < worth_mm) return;
            const std::vector<double> reference = reference_at(motion);
            const auto rows = static_cast<Eigen::Index>(motion.phase.size());
            const auto columns = static_cast<Eigen::Index>(profile.size());
            Eigen::MatrixXd derivative(rows, columns);
            Eigen::VectorXd miss(rows);
            for (Eigen::Index c = 0; c < columns; ++c) {
                constexpr double d = 1e-3;
                Profile more = profile, less = profile;
                more[static_cast<std::size_t>(c)][1] += d;
                less[static_cast<std::size_t>(c)][1] -= d;
                const HeartSpec up = spec_of(more), down = spec_of(less);
                for (Eigen::Index r = 0; r < rows; ++r) {
                    const double phase = motion.phase[static_cast<std::size_t>(r)];
                    derivative(r, c) =
                        (cathlab::profile(up, phase).displacement_mm - cathlab::profile(down, phase).displacement_mm) /
                        (2.0 * d);
                }
            }
            for (Eigen::Index r = 0; r < rows; ++r)
                miss(r) = motion.z_mm[static_cast<std::size_t>(r)] - reference[static_cast<std::size_t>(r)];
            Eigen::MatrixXd normal = derivative.transpose() * derivative;
            normal.diagonal().array() += 0.02;  // a knot that lies between two samples is not thrown far
            const Eigen::VectorXd step = normal.ldlt().solve(derivative.transpose() * miss);
            for (Eigen::Index c = 0; c < columns; ++c) {
                double& u = profile[static_cast<std::size_t>(c)][1];
                u = as_written(std::clamp(u - step(c), -most_mm, most_mm));
            }
        }
    }

    void swarm() {
        Problem problem;
        const double rmse = figures_of(best_motion_.z_mm, reference_at(best_motion_)).rmse;
        out_.reach_mm = search_.reach_mm > 0.0 ? search_.reach_mm : std::clamp(3.0 * rmse, 0.05, 5.0);
        for (const auto& [phase, displacement] : best_) {
            problem.bounds.push_back({std::max(-most_mm, displacement - out_.reach_mm),
                                      std::min(most_mm, displacement + out_.reach_mm), "profile"});
            problem.start.push_back(displacement);
        }
        out_.free = problem.bounds;
        const Profile start = best_;
        const auto profile_at = [&](std::span<const double> x) {
            Profile profile = start;
            for (std::size_t k = 0; k < x.size(); ++k) profile[k][1] = as_written(x[k]);
            return profile;
        };
        problem.objective = [&](std::span<const double> x) {
            try {
                return objective(motion_of(scene_with(profile_at(x)), 1));
            } catch (const Stopped&) {
                return infinite;
            }
        };
        const Result found = minimise_swarm(problem, search_.swarm);
        out_.best_history = found.best_history;
        out_.simulations += found.evaluations;
        out_.stopped = found.stopped;
        if (!(found.value < best_value_)) return;
        const Profile profile = profile_at(found.best);
        // Its motion was not kept in the crowd; the run is short, and wanted even after a stop.
        AnnulusMotion motion = annulus_motion(scene_with(profile), models_, search_.beats, search_.swarm.threads);
        const double value = objective(motion);
        keep(profile, std::move(motion), value);
    }

    std::string overlay() const {
        const auto number = [](double value) {
            char buffer[32];
            std::string text(buffer,
                             std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, 5).ptr);
            text.erase(text.find_last_not_of('0') + 1);
            return text.back() == '.' ? text + "0" : text;
        };
        std::string text = "[heart]\nexcursion_mm = 0.0  # the profile as it stands\nprofile = [\n";
        for (const auto& [phase, displacement] : best_)
            text += "    [" + number(phase) + ", " + number(displacement) + "],\n";
        return text + "]\n";
    }

    const HeartSearch& search_;
    const SceneModels& models_;
    HeartCalibration out_;
    Profile best_;
    AnnulusMotion best_motion_;
    double best_value_ = infinite;
};

}  // namespace

void check(const HeartSearch& search) {
    check(search.target.motion);
    const SourcePlace here{"calibrate heart", 0, ""};
    require_range(here, "knots", search.knots, 4, 64);
    require_range(here, "reach_mm", search.reach_mm, 0.0, 20.0);
    require_range(here, "beats", search.beats, 1, 20);
    if (!search.scene.heart.enabled)
        throw UserError({search.scene.path, search.scene.heart.where.line, "[heart]"},
                        "the scene has no heart: [heart] enabled = true is wanted");
}

AnnulusTarget annulus_target(const BeatMotion& reference, bool towards_apex) {
    check(reference);
    constexpr double same_mm = 1e-6;
    AnnulusTarget out;
    out.motion = reference;
    std::vector<double>& z = out.motion.displacement_mm;
    if (towards_apex)
        for (double& d : z) d = -d;
    const double least = *std::min_element(z.begin(), z.end());
    for (double& d : z) d -= least;
    const auto lowest = static_cast<std::size_t>(std::min_element(z.begin(), z.end()) - z.begin());
    std::size_t last = lowest;
    while (last + 1 < z.size() && z[last + 1] < same_mm) ++last;
    out.rest_phase = 0.5 * (reference.phase[lowest] + reference.phase[last]);
    return out;
}

SceneSpec heart_scene(const SceneSpec& scene) {
    SceneSpec out = scene;
    out.wire.enabled = false;
    out.catheter.enabled = false;
    for (SceneEffect& effect : out.effects)
        if ((effect.info->hooks & (hook_input | hook_drive | hook_measure)) != 0) effect.enabled = false;
    return out;
}

AnnulusMotion annulus_motion(const SceneSpec& scene, const SceneModels& models, int beats, int threads,
                             const std::function<bool()>& stop) {
    const auto world = build_world(scene, models, scene.seed, threads);
    prepare(*world);
    const Input nothing;
    Channels channels;
    AnnulusMotion out;
    double last = world->first<HeartState>()->phase, since = 0.0;
    const double a_step = scene.step.dt_s * scene.heart.rate_bpm / 60.0;
    const auto steps = static_cast<long>(std::ceil((beats + 1) / a_step));
    for (long k = 0; k < steps; ++k) {
        if (stop && stop()) return out;
        step(*world, nothing, channels);
        since += channels.heart_phase - last + (channels.heart_phase < last ? 1.0 : 0.0);
        last = channels.heart_phase;
        const double counted = since - 1.0;
        if (counted < 0.0 || counted >= beats) continue;
        out.beat.push_back(counted);
        out.phase.push_back(channels.heart_phase);
        out.z_mm.push_back(channels.annulus_displacement_mm);
    }
    return out;
}

HeartCalibration calibrate_heart(const HeartSearch& search, const SceneModels& models) {
    check(search);
    try {
        return Calibration(search, models).run();
    } catch (const Stopped&) {
        throw UserError("stopped before anything was found");
    }
}

}  // namespace cathlab
