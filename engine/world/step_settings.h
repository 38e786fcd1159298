// How a step is cut up, and the names of the entities that a scene may hold: what the builder of a world and the step
// agree on.
#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "core/types.h"

namespace cathlab {

/// Component of the entity "world"; const after load.
struct StepSettings {
    double dt = 0.02;                        ///< s
    int substeps = 4;                        ///< h = dt / substeps
    int iterations = 2;                      ///< passes over clusters, chain and rows in a substep
    double contact_margin_mm = 1.5;          ///< rows are made for samples nearer to the wall than this
    double sample_spacing_mm = 1.25;         ///< of contact samples along the guidewire
    double force_filter_s = 0.2;             ///< mean filter of the force bar
    double wire_contact_limit_mn = 1000.0;   ///< ... or while one of its contacts carries more than this
    double wire_penetration_limit_mm = 0.2;  ///< the drive slips while the wire is pressed in deeper than this
    Vec3 gravity_mm_s2 = Vec3::Zero();       ///< acts on the guidewire; the wall's rest pose holds its own weight
};

/// Component of the world's entity, for benchmarks: called when a stage of the step begins, with the room's name.
struct StageProbe {
    std::function<void(std::string_view room)> begin;
};

/// A model that worlds share.
template <class T>
using Shared = std::shared_ptr<const T>;

inline constexpr const char* world_entity = "world";
inline constexpr const char* vessel_entity = "vessel";
inline constexpr const char* wire_entity = "wire";
inline constexpr const char* catheter_entity = "catheter";
inline constexpr const char* heart_entity = "heart";
inline constexpr const char* camera_entity = "camera";
inline constexpr const char* contrast_entity = "contrast";

}  // namespace cathlab
