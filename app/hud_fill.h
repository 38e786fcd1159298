// Channels -> what the panels show.
#pragma once

#include "core/channels.h"
#include "hud/hud_data.h"
#include "scene/scene_spec.h"

namespace cathlab {

/// Fills everything but the messages and the two rates of the program itself.
void fill_hud(const SceneSpec& scene, const Channels& channels, HudData& out);

}  // namespace cathlab
