// One trial to watch in a browser: the tip's way through the vessels and the force bar, with a time line to drag.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/centreline.h"
#include "core/types.h"
#include "study/run_index.h"

namespace cathlab {

/// Where the tip was and how hard it pressed, as often as the page shows it.
struct TrialFrame {
    double time_s = 0.0;
    Vec3 tip = Vec3::Zero();  ///< of the task's device, mm, world
    double force_bar = 0.0;   ///< of the force limit there
    bool beam_on = false;
};

/// One HTML page that holds all it shows, with a script of its own that moves the tip.  vessels: at rest.  verified: a
/// sentence, "" = nothing is said.  The same arguments give the same bytes.
std::string trial_page(const RunEntry& run, const CentrelineGraph& vessels, std::span<const TrialFrame> frames,
                       const std::string& verified, const std::string& report);

}  // namespace cathlab
