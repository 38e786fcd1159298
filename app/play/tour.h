// Every screen as a picture, reached as a trainee reaches it: by keys.
#pragma once

#include <string>

#include "context.h"
#include "play/play_app.h"

namespace cathlab::play {

/// Opens a window that needs no display, plays the first task by keyboard, and writes one PNG a screen into the folder.
/// Throws UserError.
void tour(PlayOptions options, const AppContext& context, const std::string& folder);

/// A key goes down or up, as an event.
void send_key(SDL_Scancode key, bool down);

}  // namespace cathlab::play
