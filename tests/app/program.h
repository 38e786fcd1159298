// The program as a user calls it.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace cathlab {

struct Outcome {
    int code = -1;
    std::string text;  // stdout and stderr
};

inline Outcome call(const std::string& arguments, const std::string& environment = "") {
    Outcome out;
    const std::string command = environment + " " + CATHLAB_PROGRAM + " " + arguments + " 2>&1";
    FILE* pipe = ::popen(command.c_str(), "r");
    std::array<char, 4096> buffer{};
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe)) out.text.append(buffer.data(), n);
    const int status = ::pclose(pipe);
    out.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return out;
}

}  // namespace cathlab
