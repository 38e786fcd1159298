// One trial to watch in a browser: the device as the C-arm saw it, the tip's way through the vessels and the force bar,
// with a time line to drag.
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
    double primary_deg = 0.0, secondary_deg = 0.0;  ///< of the C-arm, DICOM's signs
    std::vector<Vec3> device = {};                  ///< its line from the tip back, mm, world; empty = not known
};

/// One HTML page that holds all it shows, with a script of its own that moves the tip.  The C-arm's view is a parallel
/// projection along its beam (beam/c_arm.h) onto image right and down.  vessels: at rest.  device_mm: how thick it is.
/// verified: a sentence, "" = nothing is said.  The same arguments give the same bytes.
std::string trial_page(const RunEntry& run, const CentrelineGraph& vessels, std::span<const TrialFrame> frames,
                       double device_mm, const std::string& verified, const std::string& report);

}  // namespace cathlab
