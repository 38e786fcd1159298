// Which codec a film is written with.
#pragma once

#include <functional>
#include <string>

#include "imaging/libav_encoder.h"

namespace cathlab {

/// name: "h264", "mpeg4" (.mp4) or "ffv1" (.avi), and nothing else is taken for it; "": as the extension says, .mp4
/// being MPEG-4 part 2 where there is no encoder of H.264.  has_encoder: what this system can write.
/// Throws UserError where the codec is unknown, does not go into a file of this extension (.mp4 or .avi), or has no
/// encoder here; path: of the film, for the sentence.
FilmCodec choose_codec(const std::string& path, const std::string& extension, const std::string& name,
                       const std::function<bool(FilmCodec)>& has_encoder);

}  // namespace cathlab
