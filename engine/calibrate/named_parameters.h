// Numbers of a scene by their path, as a scene file spells them: "wall.cluster_stiffness",
// "effects.respiration.period_s". Names, units and ranges are those of the tables that parse scene files.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "optimise/problem.h"
#include "scene/scene_spec.h"

namespace cathlab {

struct NamedParameter {
    std::string path;
    std::string unit;
    double minimum = 0.0, maximum = 0.0;  ///< what a scene file may say; may be infinite
};

/// Every number that can be named.
std::vector<NamedParameter> named_parameters();

/// Throws UserError where there is no number of that path (with the nearest known path).
NamedParameter find_named_parameter(const std::string& path);

double get_named(const SceneSpec& scene, const std::string& path);

/// Throws UserError for an unknown path and for a value out of range.  An effect whose parameter is set is switched on.
void set_named(SceneSpec& scene, const std::string& path, double value);

/// Bounds for a search: the parameter's own range, or the part lower..upper of it.  Throws UserError where that leaves
/// the parameter's range, is turned round, or is not finite.
Bound named_bound(const std::string& path);
Bound named_bound(const std::string& path, double lower, double upper);

/// TOML to lay over a scene: one section a table, keys in the order given.
std::string overlay_text(std::span<const std::string> paths, std::span<const double> values);

}  // namespace cathlab
