// Two words for a developer's mistakes.  A user's mistake is a UserError (errors.h).
#pragma once

#include <string>

namespace cathlab::detail {
[[noreturn]] void check_failed(const char* condition, const char* file, int line, const std::string& message);
}

/// Always on: throws std::logic_error with the condition, the place and the message.
#define CATHLAB_CHECK(condition, message)                                                           \
    do {                                                                                            \
        if (!(condition)) ::cathlab::detail::check_failed(#condition, __FILE__, __LINE__, message); \
    } while (false)

/// Debug builds only: for hot loops.
#ifdef NDEBUG
#define CATHLAB_ASSERT(condition) static_cast<void>(0)
#else
#define CATHLAB_ASSERT(condition) CATHLAB_CHECK(condition, "")
#endif
