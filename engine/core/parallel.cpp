// A pool of its own, and not a library's: the loops of a step are 20 to 200 us long and follow each other with as much
// between them that one thread does.  A general scheduler puts its threads to sleep in such a pause and takes longer to
// wake them than the loop lasts; here they stay awake for about that long and sleep in any longer one.
#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace cathlab {
namespace {

constexpr int spins = 4000;              // looks for work before a thread lets others run,
constexpr int yields = 2000;             // and so many more before it sleeps
constexpr std::size_t parts_each = 8;    // of a loop whose items may cost unlike
constexpr std::size_t cache_line = 128;  // two, as processors fetch them

void pause() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
}

/// Looks again and again until `ready` says yes; false when it gives up.
template <class Ready>
bool wait_awake(const Ready& ready) {
    for (int i = 0; i < spins; ++i) {
        if (ready()) return true;
        pause();
    }
    for (int i = 0; i < yields; ++i) {
        if (ready()) return true;
        std::this_thread::yield();
    }
    return false;
}

}  // namespace

/// One loop at a time.  Its parts stand in a row; each thread begins at a place of its own, the same one loop after
/// loop, and goes round: it takes what nobody has taken.  So the caller does all of it alone where no other thread
/// comes.
struct Workers::Pool {
    using Body = std::function<void(std::size_t, std::size_t)>;

    explicit Pool(int count) : taken(parts_each * static_cast<std::size_t>(count)) {
        for (int t = 1; t < count; ++t) helpers.emplace_back([this, t] { help(static_cast<std::size_t>(t)); });
    }
    ~Pool() {
        stopping.store(true);
        announce();
        for (std::thread& helper : helpers) helper.join();
    }
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;

    std::size_t threads() const { return helpers.size() + 1; }

    void run(std::size_t count, std::size_t in_parts, const Body& body) {
        // Another thread's loop, or one that encloses this one: the caller goes alone, which gives the same bits.
        std::unique_lock<std::mutex> only(busy, std::try_to_lock);
        if (!only.owns_lock()) {
            body(0, count);
            return;
        }
        items = count;
        what = &body;
        done.store(0, std::memory_order_relaxed);
        failed.store(false, std::memory_order_relaxed);
        failed_part = in_parts;
        failure = nullptr;
        const std::uint32_t turn = generation.load(std::memory_order_relaxed) + 1;
        for (std::size_t p = 0; p < in_parts; ++p) taken[p].store(free_in(turn), std::memory_order_release);
        parts.store(in_parts, std::memory_order_release);
        announce();
        take_parts(0, turn, in_parts);
        while (!wait_awake([&] { return done.load(std::memory_order_acquire) == in_parts; })) {
        }
        if (failure) std::rethrow_exception(failure);
    }

private:
    /// What stands in `taken` while a part of this turn waits; a number above it says that it was taken.  Numbers of
    /// other turns differ, so that a thread which comes late takes nothing.
    static std::uint64_t free_in(std::uint32_t turn) { return 2 * static_cast<std::uint64_t>(turn); }

    void announce() {
        generation.fetch_add(1, std::memory_order_release);
        generation.notify_all();
    }

    void help(std::size_t place) {
        std::uint32_t seen = 0;
        for (;;) {
            const auto news = [&] { return generation.load(std::memory_order_acquire) != seen; };
            while (!wait_awake(news)) generation.wait(seen, std::memory_order_acquire);
            if (stopping.load()) return;
            seen = generation.load(std::memory_order_acquire);
            take_parts(place, seen, parts.load(std::memory_order_acquire));
        }
    }

    void take_parts(std::size_t place, std::uint32_t turn, std::size_t in_parts) {
        const std::size_t first = place * in_parts / threads();
        for (std::size_t k = 0; k < in_parts; ++k) {
            const std::size_t p = first + k < in_parts ? first + k : first + k - in_parts;
            std::uint64_t free = free_in(turn);
            if (!taken[p].compare_exchange_strong(free, free + 1, std::memory_order_acq_rel)) continue;
            // From here on the loop cannot end before this part does.
            if (!failed.load(std::memory_order_relaxed)) run_part(p, in_parts);
            done.fetch_add(1, std::memory_order_release);
        }
    }

    void run_part(std::size_t p, std::size_t in_parts) {
        try {
            (*what)(p * items / in_parts, (p + 1) * items / in_parts);
        } catch (...) {
            const std::lock_guard<std::mutex> only(failing);
            failed.store(true, std::memory_order_relaxed);
            if (p < failed_part) {
                failed_part = p;
                failure = std::current_exception();
            }
        }
    }

    std::mutex busy, failing;
    alignas(cache_line) std::atomic<std::uint32_t> generation{0};
    std::atomic<bool> stopping{false};
    // The loop of this turn.
    std::atomic<std::size_t> parts{0};
    std::size_t items = 0;
    const Body* what = nullptr;
    std::atomic<bool> failed{false};
    std::size_t failed_part = 0;
    std::exception_ptr failure;
    alignas(cache_line) std::vector<std::atomic<std::uint64_t>> taken;  ///< one a part
    alignas(cache_line) std::atomic<std::size_t> done{0};
    std::vector<std::thread> helpers;
};

Workers::Workers(int threads) : pool_(threads > 1 ? std::make_shared<Pool>(threads) : nullptr) {}

int Workers::threads() const {
    return pool_ ? static_cast<int>(pool_->threads()) : 1;
}

void Workers::run(std::size_t count, std::size_t grain, std::size_t most_parts,
                  const std::function<void(std::size_t, std::size_t)>& body) const {
    if (count == 0) return;
    const std::size_t parts = std::min(most_parts, count / std::max<std::size_t>(1, grain));
    if (!pool_ || parts < 2) {
        body(0, count);
        return;
    }
    pool_->run(count, parts, body);
}

void Workers::for_ranges(std::size_t count, std::size_t grain,
                         const std::function<void(std::size_t, std::size_t)>& body) const {
    run(count, grain, parts_each * static_cast<std::size_t>(threads()), body);
}

void Workers::for_even_ranges(std::size_t count, std::size_t grain,
                              const std::function<void(std::size_t, std::size_t)>& body) const {
    run(count, grain, static_cast<std::size_t>(threads()), body);
}

}  // namespace cathlab
