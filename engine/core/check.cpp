#include "core/check.h"

#include <stdexcept>

namespace cathlab::detail {

void check_failed(const char* condition, const char* file, int line, const std::string& message) {
    std::string text = std::string(file) + ":" + std::to_string(line) + ": check failed: " + condition;
    if (!message.empty()) text += " (" + message + ")";
    throw std::logic_error(text);
}

}  // namespace cathlab::detail
