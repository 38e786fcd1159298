#include "play/xvfb.h"

#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

namespace cathlab::play {

Xvfb::Xvfb(int width, int height) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) return;
    process_ = ::fork();
    if (process_ == 0) {
        const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24";
        const std::string fd = std::to_string(ends[1]);
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // no display outlives its test
        if (::freopen("/dev/null", "w", stdout) == nullptr || ::freopen("/dev/null", "w", stderr) == nullptr)
            ::_exit(127);
        ::execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", screen.c_str(), "-nolisten", "tcp",
                 static_cast<char*>(nullptr));
        ::_exit(127);
    }
    ::close(ends[1]);
    // It says the number of its display when it is ready.
    pollfd ready{ends[0], POLLIN, 0};
    std::array<char, 16> text{};
    std::string number;
    while (number.find('\n') == std::string::npos && ::poll(&ready, 1, 20000) > 0) {
        const auto n = ::read(ends[0], text.data(), text.size());
        if (n <= 0) break;
        number.append(text.data(), static_cast<std::size_t>(n));
    }
    ::close(ends[0]);
    if (number.find('\n') == std::string::npos) return;
    display_ = ":" + number.substr(0, number.find('\n'));
    ::setenv("DISPLAY", display_.c_str(), 1);
    ::setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
}

Xvfb::~Xvfb() {
    if (process_ <= 0) return;
    ::kill(process_, SIGTERM);
    ::waitpid(process_, nullptr, 0);
    ::unsetenv("DISPLAY");
}

}  // namespace cathlab::play
