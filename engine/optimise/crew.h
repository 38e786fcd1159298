// Threads for searches within searches: a search tries several starts, a start asks for derivatives, a derivative runs
// recordings.  Loops of seconds, where core/parallel.h's are of microseconds.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace cathlab {

/// A loop inside another one's body is shared by whoever has nothing to do, so that the longest body does not end
/// alone.  Copies share the threads; calls may come from several of them at once.
class Crew {
public:
    Crew() = default;  ///< everything runs in the caller, as with one thread
    explicit Crew(int threads);
    int threads() const;

    /// Calls body(k) for each k below count; body writes only what is k's own, so that results do not depend on the
    /// number of threads.  An exception passes through to the caller; bodies that have not begun by then do not.
    void each(std::size_t count, const std::function<void(std::size_t)>& body) const;

private:
    struct Arena;
    std::shared_ptr<Arena> arena_;  // null for one thread
};

}  // namespace cathlab
