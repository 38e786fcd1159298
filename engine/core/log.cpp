#include "core/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/errors.h"

namespace cathlab::log {
namespace {

// spdlog's registry is the program's, not a world's: nothing that reaches a state or a hash depends on it.
spdlog::logger& logger() {
    static const std::shared_ptr<spdlog::logger> instance = [] {
        auto made = spdlog::stderr_color_mt("cathlab");
        made->set_pattern("%^%l%$: %v");
        return made;
    }();
    return *instance;
}

}  // namespace

void set_level(const std::string& level) {
    const std::vector<std::string> known{"trace", "debug", "info", "warn", "error", "off"};
    if (std::find(known.begin(), known.end(), level) == known.end())
        throw UserError("--log-level '" + level + "' is not one of " + comma_list(known) + did_you_mean(level, known),
                        true);
    logger().set_level(spdlog::level::from_str(level));
}

void debug(const std::string& message) {
    logger().debug(message);
}
void info(const std::string& message) {
    logger().info(message);
}
void warn(const std::string& message) {
    logger().warn(message);
}
void error(const std::string& message) {
    logger().error(message);
}

}  // namespace cathlab::log
