// What a participant of a study does next, and where it is kept.
#pragma once

#include <optional>
#include <string>

#include "context.h"
#include "play/tasks.h"
#include "study/protocol.h"

namespace cathlab::play {

class StudyDesk {
public:
    /// Throws UserError: no study there, nobody of that name, a synthetic participant.
    StudyDesk(const std::string& study, const std::string& participant, const AppContext& context);

    /// The first trial that is not done; empty = all are.
    const std::optional<Trial>& next() const { return next_; }
    int done() const { return done_; }
    int total() const { return total_; }
    const std::string& participant() const { return participant_; }
    /// Of the next trial.  Throws UserError where the scene is wrong.
    TaskScene task() const;
    std::uint64_t seed() const;

    /// Makes room for the next trial: a folder of its own, that takes its name when it is whole.
    std::string begin();
    /// The trial is whole: it gets its name, which is returned, and the one after it is next.  Throws UserError.
    std::string keep();

private:
    void look();
    std::string folder() const { return study_ + "/" + next_->folder; }

    const AppContext& context_;
    std::string study_, participant_;
    Protocol protocol_;
    std::optional<Trial> next_;
    int done_ = 0, total_ = 0;
};

}  // namespace cathlab::play
