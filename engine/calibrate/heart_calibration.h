// The heart's profile from the motion of the annulus: what the cylinder has to do so that the ring follows a reference.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "calibrate/figures.h"
#include "calibrate/reference.h"
#include "optimise/swarm.h"
#include "scene/build_world.h"

namespace cathlab {

/// The reference as the simulator counts: z = displacement of the annulus along its axis into the aorta, 0 at rest. The
/// rest pose of an anatomy is the moment at which the annulus stands nearest to the apex (heart/motion.h).
struct AnnulusTarget {
    BeatMotion motion;        ///< displacement_mm = z >= 0
    double rest_phase = 0.0;  ///< where it is 0: in the middle of the stretch that lies within 1e-6 mm of it
};

/// towards_apex: the reference counts towards the apex (else into the aorta).
AnnulusTarget annulus_target(const BeatMotion& reference, bool towards_apex);

struct HeartSearch {
    /// Wall, anatomy, heart and rate.  Devices are left out, and effects that do not make the wall itself: respiration
    /// for one would move the ring too.
    SceneSpec scene;
    AnnulusTarget target;
    int knots = 16;         ///< of the profile, 4 to 64; placed where the reference bends most
    double reach_mm = 0.0;  ///< the swarm looks this far to either side of its start, 0 to 20; 0 = 3 RMSE there
    bool at_peaks = false;  ///< objective: the error at the peaks of each beat (and a tenth of the RMSE); else the RMSE
    int beats = 3;          ///< that count, 1 to 20; one more goes before them
    SwarmOptions swarm;
    std::function<bool()> stop;                          ///< asked while a world runs; true = end with the best so far
    std::function<void(int simulations)> on_simulation;  ///< before and after the swarm, which reports by itself
};

/// Throws UserError for a bad reference, options out of range, and a scene without a heart: what can be told before
/// models are built.
void check(const HeartSearch& search);

/// The annulus over the beats that count, a sample a step.
struct AnnulusMotion {
    std::vector<double> beat;  ///< beats since the first of them began; phase = rest of it + the first sample's
    std::vector<double> phase;
    std::vector<double> z_mm;
};

struct HeartCalibration {
    std::vector<std::array<double, 2>> profile;      ///< (phase, displacement of the cylinder, mm), for [heart] profile
    AnnulusMotion first, motion;                     ///< with the scene's own profile, and with the best
    std::vector<double> reference_first, reference;  ///< z of the target at their samples, mm
    Figures figures_first, figures_start, figures;   ///< mm; start = where the swarm began
    std::vector<Bound> free;                         ///< of the swarm
    std::vector<double> best_history;                ///< objective after each generation
    double reach_mm = 0.0;                           ///< of the swarm, as taken
    int simulations = 0;
    bool stopped = false;
    std::string overlay;  ///< TOML to lay over a scene
};

/// The scene as the calibration runs it.
SceneSpec heart_scene(const SceneSpec& scene);

/// Runs `beats` beats after one more and gives the annulus' motion; shorter where stop asked for it.
AnnulusMotion annulus_motion(const SceneSpec& scene, const SceneModels& models, int beats, int threads,
                             const std::function<bool()>& stop = {});

/// First the inverse: the annulus hangs on the cylinder and follows it nearly one to one, so a few Gauss-Newton steps
/// with the profile's own derivatives, each one run, lead near the least squares.  From there a swarm over the knots,
/// and the same steps once more.  `models` are those of heart_scene(search.scene), shared by all worlds.
/// Throws UserError as check() does, for an anatomy without an annulus, and where it is stopped before the first run
/// was over.  Same result on any number of threads.
HeartCalibration calibrate_heart(const HeartSearch& search, const SceneModels& models);

}  // namespace cathlab
