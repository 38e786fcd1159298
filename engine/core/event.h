// Something that happened at a step and that a person or a score wants to know: a refused command, a clamped action.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace cathlab {

struct Event {
    std::int64_t step = 0;  ///< steps done before the one in which it happened
    double time_s = 0.0;
    std::string kind;    ///< "refused", "clamped", "contact", "limit", ...
    std::string entity;  ///< name of the entity that it concerns
    std::string message;
    double value = 0.0;  ///< the number that belongs to the message, in its unit
};

/// Component of the world's own entity: what happened and was not yet taken by an observer.  Not part of the state
/// hash.
struct EventLog {
    std::vector<Event> pending;
};

}  // namespace cathlab
