// The few lines that tell the operator what happened, newest last, each for a few seconds.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "core/event.h"

namespace cathlab {

class MessageLines {
public:
    /// A command that is refused is refused in every step: the same sentence moves on instead of filling the lines.
    void add(const Event& event);
    /// The lines that are still shown at that time.
    void at(double time_s, std::vector<std::string>& out);

private:
    std::deque<Event> events_;
};

}  // namespace cathlab
