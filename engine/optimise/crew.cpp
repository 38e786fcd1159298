#include "optimise/crew.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace cathlab {

struct Crew::Arena {
    explicit Arena(int threads) : arena(threads) {}
    tbb::task_arena arena;
};

Crew::Crew(int threads) : arena_(threads > 1 ? std::make_shared<Arena>(threads) : nullptr) {}

int Crew::threads() const {
    return arena_ ? arena_->arena.max_concurrency() : 1;
}

void Crew::each(std::size_t count, const std::function<void(std::size_t)>& body) const {
    if (!arena_ || count < 2) {
        for (std::size_t k = 0; k < count; ++k) body(k);
        return;
    }
    arena_->arena.execute([&] {
        // Who waits for the end of this loop helps with it alone: a body of a loop further out may last for minutes.
        tbb::this_task_arena::isolate([&] {
            tbb::parallel_for(
                tbb::blocked_range<std::size_t>(0, count, 1),
                [&](const tbb::blocked_range<std::size_t>& range) {
                    for (std::size_t k = range.begin(); k < range.end(); ++k) body(k);
                },
                tbb::simple_partitioner());
        });
    });
}

}  // namespace cathlab
