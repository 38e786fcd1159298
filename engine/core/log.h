// The program's log, spdlog behind one door.  The engine logs seldom: what a user must see is an event or an error.
#pragma once

#include <string>

namespace cathlab::log {

/// level: "trace", "debug", "info", "warn", "error" or "off"; throws UserError with the list otherwise.  Output goes to
/// stderr.
void set_level(const std::string& level);
void debug(const std::string& message);
void info(const std::string& message);
void warn(const std::string& message);
void error(const std::string& message);

}  // namespace cathlab::log
