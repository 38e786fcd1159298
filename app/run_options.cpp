#include "run_options.h"

#include <cmath>

#include "core/csv.h"
#include "core/errors.h"

namespace cathlab {

void require_finite(const char* option, double value) {
    if (!std::isfinite(value)) throw UserError(std::string(option) + ": a finite number is wanted", true);
}

FilmOptions film_options(const FilmArguments& arguments, const SceneSpec& scene, const std::string& path) {
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
    return out;
}

}  // namespace cathlab
