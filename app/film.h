// The film of a run: a picture of the world at equal intervals of simulated time.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/channels.h"
#include "core/event.h"
#include "imaging/image.h"
#include "scene/scene_spec.h"
#include "world/world.h"

namespace cathlab {

struct FilmOptions {
    std::string path;  ///< "" = no film, pictures alone (for a benchmark)
    int width = 1024;
    int height = 512;
    double fps = 15.0;
};

class Film {
public:
    /// Throws UserError: no off-screen GL, no encoder, an unwritable folder, an odd size.
    Film(const SceneSpec& scene, const FilmOptions& options, int threads);
    ~Film();
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    /// Whether a picture is due after the step that ended at `time_s`.
    bool due(double time_s) const;
    /// Draws the world as it stands and appends the picture.
    void add(World& world, const Channels& channels);
    /// Keeps an event for the message lines.
    void message(const Event& event);
    /// The last picture; empty before the first.
    const Image8& last() const;
    std::size_t frames() const;
    /// Closes the film; it then holds all pictures so far (none: nothing is written).
    void close();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
