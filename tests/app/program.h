// The program as a user calls it.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <sstream>
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

/// One line, ended, that begins with the program's name.  On a slow machine lines of progress may go before it
/// ("building: 90 %, surface, 1 s left").
inline testing::AssertionResult one_sentence(const Outcome& outcome) {
    std::istringstream lines(outcome.text);
    int sentences = 0;
    bool other = !outcome.text.ends_with('\n');
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("cathlab: "))
            ++sentences;
        else if (sentences > 0 || !line.starts_with("building: ") || line.find(" %, ") == std::string::npos)
            other = true;
    }
    if (sentences == 1 && !other) return testing::AssertionSuccess();
    return testing::AssertionFailure() << outcome.text;
}

}  // namespace cathlab
