// Recordings made by formulas of their own, of which the engine knows nothing: own kinematics, own laws, own noise.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "explain/folder.h"

namespace explain_test {

/// One made data set.  strength: 1 = weak but well above the noise, 2 = strong.
struct Recipe {
    std::string kind;  ///< "catheter-tip", "heart-motion", "wall-tension", "tendon-tip" or "wall-contact"
    /// "" = nothing acts; an effect's name; two of them, "a+b"; or one that no manifest holds: "vibration", "step",
    /// "outliers", "grip-slip"
    std::string effect;
    int strength = 1;
    std::uint64_t seed = 1;
    int rows = 1200;
};

std::unique_ptr<Folder> record(const Recipe& recipe);

/// The effects that a kind's recordings can be made with.
const std::vector<std::string>& known_effects(const std::string& kind);
/// Two that act at once, "a+b".
const std::vector<std::string>& effect_pairs(const std::string& kind);
/// Those that no manifest holds.
const std::vector<std::string>& foreign_effects(const std::string& kind);

}  // namespace explain_test
