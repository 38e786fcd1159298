// Which particles form which cluster.
#pragma once

#include <vector>

#include "softbody/model.h"
#include "softbody/wall_sample.h"

namespace cathlab {

/// (clusters) particles of each, ascending; clusters in the order of their centres.
using Membership = std::vector<std::vector<Index>>;

/// Grows the clusters.  Throws UserError where a particle is left without one.
Membership grow_clusters(const WallSample& sample, const WallParameters& parameters);

/// Orders clusters into lanes of like size and fills cluster_start, cluster, cluster_count and the groups of the wanted
/// precision.  Needs rest and mass.
void pack_clusters(const Membership& membership, SoftBodyModel& model);

}  // namespace cathlab
