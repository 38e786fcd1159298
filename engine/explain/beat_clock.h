// Where in which beat a row stands, from the beats that were recorded.
#pragma once

#include "explain/dataset.h"

namespace cathlab {

/// Phase of the beat at a time, 0 to 1, and NaN before the first and after the last beat.
double beat_phase(const std::vector<double>& beats, double time_s);

/// The beats among recorded triggers: an electrocardiogram's second wave may trigger once more within a beat.  Of all
/// choices of triggers the one whose intervals are nearest to the rhythm (the shortest distance that many pairs of
/// triggers have); one that comes early and is followed by a pause is a beat and stays.
std::vector<double> beats_among(const std::vector<double>& triggers);

struct BeatTime {
    double phase = 0.0;       ///< 0 to 1; before the first and after the last beat the neighbour's length goes on
    std::int64_t number = 0;  ///< of the beat within its recording
    double usual_s = 0.0;     ///< median length of the recording's beats; 0 = no beats recorded
    double interval = 0.0;    ///< length of the beat before this one, in usual beats; 1 where it is not known
};

class BeatClock {
public:
    explicit BeatClock(const Dataset& data);
    /// Triggers that were taken for false.
    std::size_t dropped() const { return dropped_; }
    /// Every run has two beats or more.
    bool recorded() const { return recorded_; }
    BeatTime at(std::size_t row) const { return recorded_ ? rows_[row] : BeatTime{}; }

private:
    bool recorded_ = false;
    std::size_t dropped_ = 0;
    std::vector<BeatTime> rows_;
};

}  // namespace cathlab
