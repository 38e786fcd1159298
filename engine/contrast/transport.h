// The bolus: contrast medium carried by the flow, mixed over each cross-section, washed out at the ends.
#pragma once

#include <vector>

#include "contrast/flow.h"
#include "core/archive.h"

namespace cathlab {

struct ContrastState {
    std::vector<double> concentration;  ///< one a node, mgI/mL, mean over the lumen
    double injected_ml = 0.0;           ///< medium since the start
    double injected_mg = 0.0;           ///< iodine since the start
    double washed_out_mg = 0.0;         ///< iodine that has left through the ends or back into the heart
};
void visit(Archive& archive, ContrastState& state);

ContrastState initial_state(const ContrastModel& model);

struct Injection {
    Index node = 0;          ///< of the centre-line graph, nearest to the device's tip
    double flow_ml_s = 0.0;  ///< of the medium, >= 0
};

/// One step of dt seconds.  flow_scale multiplies the heart's flow (1 = mean; an effect or the heart may make it
/// pulsate; >= 0).
///
/// The vessels beyond the injection keep their flow (their resistance sets it), so the medium takes the place of blood
/// from upstream: on the way from the root to the node the flow falls by the injected flow, and where it turns negative
/// the medium runs back (reflux), at most into the heart.  Where the injection exceeds what leaves beyond a loop the
/// concentration is not limited to the medium's.
///
/// Implicit upwind: node by node down the flow,
///     c = (V c_old + dt (sum inflow c_upstream + injected)) / (V + dt outflow),
/// positive and stable for any dt; iodine in the tree + washed out = injected, to rounding.  Its numerical dispersion,
/// about u (spacing + u dt) / 2, stands in for the true one (Taylor's is larger in a laminar vessel).
void advance(const ContrastModel& model, ContrastState& state, const Injection& injection, double dt,
             double flow_scale = 1.0);

/// Iodine in the tree, mg.
double iodine_in_tree_mg(const ContrastModel& model, const ContrastState& state);

}  // namespace cathlab
