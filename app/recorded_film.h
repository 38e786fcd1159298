// The pictures of a recorded run from its poses.bin, without a step.
#pragma once

#include <cstdint>

#include "context.h"
#include "film.h"
#include "record/run_reader.h"
#include "scene/scene_spec.h"

namespace cathlab {

class RecordedFilm {
public:
    /// Fetches the anatomy, reads trace.csv and events.jsonl, opens poses.bin.  threads: for the anatomy and for what
    /// describes a picture.  Throws UserError: what is missing, cut, changed, or of another anatomy.
    RecordedFilm(const RunRecord& run, const SceneSpec& scene, int threads, const AppContext& context);
    RecordedFilm(const RecordedFilm&) = delete;
    RecordedFilm& operator=(const RecordedFilm&) = delete;

    /// Hands the pictures that are due in steps [0, end) to the film: what moves as the last poses up to that step have
    /// it, all else as the step's row has it.  Stops after a picture where a signal asks for it.  Gives the steps done.
    std::int64_t film(Film& film, std::int64_t end);

    /// Of the poses.
    double rate_hz() const { return poses_.rate_hz(); }
    /// Steps of the run that have a row.
    std::int64_t steps() const;

private:
    std::shared_ptr<const AnatomyModel> anatomy_;
    BeamSpec beam_;
    Workers workers_;
    std::vector<Channels> trace_;
    std::vector<Event> events_;
    PosesReader poses_;
};

}  // namespace cathlab
