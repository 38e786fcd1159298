// The program as a user calls it.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
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

/// One line, ended, that begins with the program's name.
inline testing::AssertionResult one_sentence(const Outcome& outcome) {
    const auto lines = std::count(outcome.text.begin(), outcome.text.end(), '\n');
    if (lines == 1 && outcome.text.rfind("cathlab: ", 0) == 0) return testing::AssertionSuccess();
    return testing::AssertionFailure() << outcome.text;
}

}  // namespace cathlab
