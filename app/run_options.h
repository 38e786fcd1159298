// What `run` and `replay` share of their command lines.
#pragma once

#include <string>

#include "film.h"
#include "scene/scene_spec.h"

namespace CLI {
class App;
}

namespace cathlab {

struct FilmArguments {
    std::string video;                 ///< "" = the subcommand's default, "none" = no film
    std::string size;                  ///< "WxH", "" = the scene's
    double fps = 0.0;                  ///< 0 = the scene's
    std::string labels;                ///< "" or "coco": labels.json beside the film
    std::string dicom;                 ///< "" or a file
    std::string codec;                 ///< "" = as the film's name says
    std::string frames;                ///< "" or a folder
    std::string frame_format = "png";  ///< or "float"
    ViewChange view;
};

/// --video, --size, --fps, --labels, --dicom, --frames and --frame-format.
void add_film_options(CLI::App& command, FilmArguments& arguments, const std::string& video_text);

/// Whether pictures are wanted: a film, or anything else that is made of them.
bool filmed(const FilmArguments& arguments);

/// path = the film's file; folder = where labels.json goes.  Throws UserError (wrong use) for a size that is not WxH,
/// odd, or out of range.
FilmOptions film_options(const FilmArguments& arguments, const SceneSpec& scene, const std::string& path,
                         const std::string& folder);

/// Throws UserError (wrong use) for NaN and infinities, which CLI11's ranges let pass.
void require_finite(const char* option, double value);

}  // namespace cathlab
