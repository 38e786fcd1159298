// Parallel loops whose result cannot depend on the number of threads: each body writes only its own range.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace cathlab {

/// A pool of workers for one world.  threads = 1 runs everything in the caller.  Copies share the pool; a loop within a
/// loop, or beside one of another thread, runs in its caller.
class Workers {
public:
    explicit Workers(int threads = 1);
    int threads() const;

    /// Calls body(begin, end) on disjoint ranges that cover [0, count); ranges hold at least `grain` items.
    /// body must write only what belongs to its range (gather, not scatter).  An exception passes through to the
    /// caller, the one of the lowest range where several throw at once.
    void for_ranges(std::size_t count, std::size_t grain,
                    const std::function<void(std::size_t begin, std::size_t end)>& body) const;

    /// The same for items that cost alike, again and again in one order: each thread gets one part, and as far as can
    /// be the one that it had last time, which is still in its cache.
    void for_even_ranges(std::size_t count, std::size_t grain,
                         const std::function<void(std::size_t begin, std::size_t end)>& body) const;

private:
    void run(std::size_t count, std::size_t grain, std::size_t most_parts,
             const std::function<void(std::size_t, std::size_t)>& body) const;
    struct Pool;
    std::shared_ptr<Pool> pool_;  // null for one thread
};

}  // namespace cathlab
