// How fast the trainer is on this machine: played by itself for a while, in real time.
#pragma once

#include "context.h"
#include "play/play_app.h"

namespace cathlab::play {

/// Begins the options' scene at once, moves the wire to and fro under X-rays, and prints what was measured.
void measure(PlayOptions options, const AppContext& context, double seconds);

}  // namespace cathlab::play
