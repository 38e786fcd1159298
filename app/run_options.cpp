#include "run_options.h"

#include <CLI/CLI.hpp>
#include <cmath>

#include "core/csv.h"
#include "core/errors.h"

namespace cathlab {

void require_finite(const char* option, double value) {
    if (!std::isfinite(value)) throw UserError(std::string(option) + ": a finite number is wanted", true);
}

bool filmed(const FilmArguments& arguments) {
    return arguments.video != "none" || !arguments.labels.empty() || !arguments.dicom.empty() ||
           !arguments.frames.empty();
}

void add_film_options(CLI::App& command, FilmArguments& arguments, const std::string& video_text) {
    command.add_option("--video", arguments.video, video_text);
    command.add_option(
        "--codec", arguments.codec,
        "of the film: h264 or mpeg4 (.mp4), ffv1 (.avi); else as its name says, and for .mp4 what there is");
    command.add_option("--size", arguments.size, "of the film, WxH; else the scene's");
    command.add_option("--fps", arguments.fps, "pictures a second of simulated time; else the scene's")
        ->check(CLI::Range(1.0, 120.0));
    command
        .add_option("--labels", arguments.labels, "coco: labels.json with masks, key points and camera of each picture")
        ->check(CLI::IsMember({"coco"}));
    command.add_option("--dicom", arguments.dicom, "the fluoroscopy as a DICOM file (X-ray angiography, multi-frame)");
    command.add_option("--frames", arguments.frames,
                       "a folder for what the detector read in each picture, before its display");
    command
        .add_option("--frame-format", arguments.frame_format,
                    "of --frames: png (16 bits, 4096 = what the exposure aims at) or float (raw photons)")
        ->check(CLI::IsMember({"png", "float"}))
        ->capture_default_str();
}

FilmOptions film_options(const FilmArguments& arguments, const SceneSpec& scene, const std::string& path,
                         const std::string& folder) {
    FilmOptions out{path, scene.video.width, scene.video.height, scene.video.fps};
    if (!arguments.size.empty()) {
        const std::string_view size(arguments.size);
        const auto cross = size.find('x');
        const bool two = cross != std::string_view::npos;
        const auto width = parse_number<int>(size.substr(0, cross));
        const auto height = two ? parse_number<int>(size.substr(cross + 1)) : std::nullopt;
        out.width = width.value_or(0);
        out.height = height.value_or(0);
        if (out.width < 64 || out.height < 64 || out.width > 7680 || out.height > 4320 || out.width % 2 != 0 ||
            out.height % 2 != 0)
            throw UserError("--size '" + arguments.size + "': two even numbers are wanted, 64x64 to 7680x4320", true);
    }
    require_finite("--fps", arguments.fps);
    if (arguments.fps > 0.0) out.fps = arguments.fps;
    if (!arguments.labels.empty()) out.labels = folder + "/labels.json";
    out.codec = arguments.codec;
    out.dicom = arguments.dicom;
    out.frames = arguments.frames;
    out.frames_as_float = arguments.frame_format == "float";
    out.view = arguments.view;
    const ViewChange& view = arguments.view;
    DicomFacts& facts = out.dicom_facts;
    facts.description = scene.title.empty() ? scene.name : scene.title;
    facts.software = "cathlab " CATHLAB_VERSION;
    facts.frames_per_s = out.fps;
    facts.sid_mm = view.sid_mm.value_or(scene.c_arm.sid_mm);
    facts.sod_mm = view.sod_mm.value_or(scene.c_arm.sod_mm);
    facts.round_field = (view.detector.empty() ? scene.c_arm.detector : view.detector) == "image_intensifier";
    facts.identity = scene.hash ^ scene.seed;
    return out;
}

}  // namespace cathlab
