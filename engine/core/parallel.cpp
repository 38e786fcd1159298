#include "core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace cathlab {
namespace {

// A distribution's scheduler is not compiled for ThreadSanitizer, which then cannot see that the bodies of a loop begin
// after its caller came and end before it goes on.  It is told so here, and no more: a race of two bodies is still
// found.
#ifdef __SANITIZE_THREAD__
void hand_over(const void* at) {
    __tsan_release(const_cast<void*>(at));
}
void take_over(const void* at) {
    __tsan_acquire(const_cast<void*>(at));
}
#else
void hand_over(const void*) {}
void take_over(const void*) {}
#endif

/// Does so at the end of its block, an exception's too.
struct AtEnd {
    void (*what)(const void*);
    const void* at;
    ~AtEnd() { what(at); }
};

/// One loop, as its caller sees it.
struct Loop {
    const std::function<void(std::size_t, std::size_t)>* body;
    char begun = 0, ended = 0;
};

/// What the scheduler copies for every part of a loop that it splits off: one thread writes the copy, where another's
/// may have lain, and another runs it.
class Part {
public:
    explicit Part(Loop& loop) { set(loop); }
    Part(const Part& other) { set(*other.loop()); }
    Part& operator=(const Part&) = delete;
    ~Part() { hand_over(this); }
    void operator()(const tbb::blocked_range<std::size_t>& range) const {
        Loop& of = *loop();
        take_over(&of.begun);
        const AtEnd after{hand_over, &of.ended};
        (*of.body)(range.begin(), range.end());
    }

private:
    void set(Loop& loop) {
        take_over(this);
        loop_ = &loop;
        hand_over(this);
    }
    Loop* loop() const {
        take_over(this);
        return loop_;
    }
    Loop* loop_;
};

}  // namespace

struct Workers::Pool {
    explicit Pool(int threads) : arena(threads) {}
    tbb::task_arena arena;
};

Workers::Workers(int threads) : pool_(threads > 1 ? std::make_shared<Pool>(threads) : nullptr) {}

int Workers::threads() const {
    return pool_ ? pool_->arena.max_concurrency() : 1;
}

template <class Partitioner>
void Workers::run(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body) const {
    if (count == 0) return;
    if (!pool_ || count <= grain) {
        body(0, count);
        return;
    }
    // isolate: a worker that waits here must not pick up another world's outer task, which could deadlock on locks
    // above us.
    Loop loop{&body};
    const AtEnd after_all{take_over, &loop.ended};
    hand_over(&loop.begun);
    pool_->arena.execute([&] {
        tbb::this_task_arena::isolate([&] {
            tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, std::max<std::size_t>(1, grain)), Part(loop),
                              Partitioner());
        });
    });
}

void Workers::for_ranges(std::size_t count, std::size_t grain,
                         const std::function<void(std::size_t, std::size_t)>& body) const {
    run<tbb::auto_partitioner>(count, grain, body);
}

void Workers::for_even_ranges(std::size_t count, std::size_t grain,
                              const std::function<void(std::size_t, std::size_t)>& body) const {
    run<tbb::static_partitioner>(count, grain, body);
}

}  // namespace cathlab
