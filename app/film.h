// The film of a run: a picture of the world at equal intervals of simulated time.
#pragma once

#include <memory>

#include "core/channels.h"
#include "core/event.h"
#include "imaging/image.h"
#include "scene/scene_spec.h"
#include "studio.h"
#include "take_poses.h"
#include "world/world.h"

namespace cathlab {

/// How the threads of a command are shared out between the step and the film.
struct ThreadShares {
    int step = 1;
    int film = 0;  ///< 0: each picture is drawn before the next step; 1: beside it; 2: drawn and encoded beside it
};

/// threads >= 1 in all.  With a film and more than one thread, one of them draws and encodes; of four or more, one
/// draws and another encodes: the step gains less from a third thread than the film from a second.
ThreadShares share_threads(int threads, bool with_film);

/// Pictures are described by the caller's thread (a snapshot of what the renderer needs) and drawn and encoded either
/// there or on threads of their own, behind a short queue.  No picture is ever dropped: where the queue is full, add()
/// waits.  The pictures are the same either way, whatever the threads' timing.
class Film {
public:
    /// threads: 0 to 2 of its own (ThreadShares).  Throws UserError: no off-screen GL, no encoder, an unwritable
    /// folder, an odd size.
    Film(const SceneSpec& scene, const FilmOptions& options, int threads);
    /// Without close() before it: the film is given up.
    ~Film();
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;

    /// Whether a picture is due after the step that ended at `time_s`.
    bool due(double time_s) const;
    /// Takes a picture of the world as it stands.  Throws what stopped the film, be it this picture or an earlier one.
    void add(World& world, const Channels& channels);
    /// The same of a world that stood so.
    void add(const FrameStage& stage, const ScenePoses& poses, const Channels& channels);
    /// Keeps an event for the message lines.
    void message(const Event& event);
    /// The last picture so far becomes the poster.
    void keep_poster();
    /// The poster, or the last picture where none was kept; waits until it is drawn.  Throws what stopped the film.
    Image8 poster();
    /// Pictures taken so far.
    std::size_t frames() const;
    /// Whether an error stopped the film: it has been thrown, or the next call will throw it.
    bool failed() const;
    /// Closes the film; it then holds all pictures so far (none: nothing is written).  Throws UserError.
    void close();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
