#include "message_lines.h"

namespace cathlab {
namespace {

constexpr std::size_t most_lines = 4;
constexpr double shown_s = 4.0;

}  // namespace

void MessageLines::add(const Event& event) {
    for (Event& known : events_) {
        if (known.kind != event.kind || known.entity != event.entity) continue;
        known = event;
        return;
    }
    events_.push_back(event);
    if (events_.size() > most_lines) events_.pop_front();
}

void MessageLines::at(double time_s, std::vector<std::string>& out) {
    while (!events_.empty() && events_.front().time_s < time_s - shown_s) events_.pop_front();
    out.clear();
    for (const Event& event : events_) out.push_back(event.message);
}

}  // namespace cathlab
