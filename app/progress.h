// How far a long job is and how long it still takes, on stderr.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace cathlab {

/// Says nothing in the first two seconds.  On a terminal one line is drawn over and over; elsewhere plain lines come,
/// one in ten seconds.  NO_COLOR is kept: no escape sequence is ever needed but the one that clears the line.
class Progress {
public:
    explicit Progress(std::string job, bool quiet = false);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// fraction in [0, 1]; detail = a few words ("wall", "12.4 of 60 s").
    void update(double fraction, std::string_view detail = "");
    /// Ends the line; the job is done or given up.
    void end();

private:
    using Clock = std::chrono::steady_clock;
    std::string job_;
    bool quiet_;
    bool terminal_;
    bool drawn_ = false;
    Clock::time_point begin_ = Clock::now();
    Clock::time_point last_ = begin_;
};

/// "3 s", "2 min 5 s", "1 h 4 min".
std::string duration_text(double seconds);

}  // namespace cathlab
