// A display that nobody sees, for the time of a test.
#pragma once

#include <string>

namespace cathlab::play {

class Xvfb {
public:
    /// Starts one with llvmpipe; started() is false where the program Xvfb is missing.
    Xvfb(int width, int height);
    ~Xvfb();
    Xvfb(const Xvfb&) = delete;
    Xvfb& operator=(const Xvfb&) = delete;
    bool started() const { return !display_.empty(); }

private:
    int process_ = -1;
    std::string display_;
};

}  // namespace cathlab::play
