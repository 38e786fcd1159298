#include "progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace cathlab {
namespace {

constexpr double silent_s = 2.0;
constexpr double redraw_s = 0.2;
constexpr double line_s = 10.0;

bool stderr_is_terminal() {
    const char* kind = std::getenv("TERM");
    return ::isatty(STDERR_FILENO) == 1 && kind != nullptr && std::string_view(kind) != "dumb";
}

}  // namespace

std::string duration_text(double seconds) {
    const auto s = std::lround(std::max(0.0, seconds));
    if (s < 60) return std::to_string(s) + " s";
    if (s < 3600) return std::to_string(s / 60) + " min " + std::to_string(s % 60) + " s";
    return std::to_string(s / 3600) + " h " + std::to_string(s % 3600 / 60) + " min";
}

Progress::Progress(std::string job, bool quiet)
    : job_(std::move(job)), quiet_(quiet), terminal_(stderr_is_terminal()) {}

Progress::~Progress() {
    end();
}

void Progress::update(double fraction, std::string_view detail) {
    if (quiet_) return;
    const auto now = Clock::now();
    const double elapsed = std::chrono::duration<double>(now - begin_).count();
    const double since = std::chrono::duration<double>(now - last_).count();
    if (elapsed < silent_s || since < (terminal_ ? redraw_s : drawn_ ? line_s : 0.0)) return;
    last_ = now;
    fraction = std::clamp(fraction, 0.0, 1.0);
    std::string line = job_ + ": " + std::to_string(static_cast<int>(100.0 * fraction)) + " %";
    if (!detail.empty()) line += ", " + std::string(detail);
    if (fraction > 0.01) line += ", " + duration_text(elapsed * (1.0 - fraction) / fraction) + " left";
    if (terminal_)
        std::fprintf(stderr, "\r\033[K%s", line.c_str());
    else
        std::fprintf(stderr, "%s\n", line.c_str());
    std::fflush(stderr);
    drawn_ = true;
}

void Progress::end() {
    if (terminal_ && drawn_) std::fprintf(stderr, "\r\033[K");
    drawn_ = false;
    quiet_ = true;
}

}  // namespace cathlab
