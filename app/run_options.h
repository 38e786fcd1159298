// What `run` and `replay` share of their command lines.
#pragma once

#include <string>

#include "film.h"
#include "scene/scene_spec.h"

namespace cathlab {

struct FilmArguments {
    std::string video;  ///< "" = the subcommand's default, "none" = no film
    std::string size;   ///< "WxH", "" = the scene's
    double fps = 0.0;   ///< 0 = the scene's
};

/// path = the film's file.  Throws UserError (wrong use) for a size that is not WxH, odd, or out of range.
FilmOptions film_options(const FilmArguments& arguments, const SceneSpec& scene, const std::string& path);

/// Throws UserError (wrong use) for NaN and infinities, which CLI11's ranges let pass.
void require_finite(const char* option, double value);

}  // namespace cathlab
