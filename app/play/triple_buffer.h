// The newest of what one thread makes, for one other thread, without either waiting for the other's work.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>

namespace cathlab::play {

template <class T>
class TripleBuffer {
public:
    /// The writer's own: holds what an earlier turn left in it.
    T& back() { return slots_[back_]; }
    /// The writer hands it over; what was handed over and not taken is dropped.
    void publish() {
        {
            const std::lock_guard lock(mutex_);
            std::swap(back_, middle_);
            fresh_ = true;
        }
        changed_.notify_one();
    }
    /// The reader takes the newest; false where there is none since the last time.
    bool take() {
        const std::lock_guard lock(mutex_);
        return take_locked();
    }
    /// The same, waiting for one at most so long or until wake().
    bool take_within(std::chrono::milliseconds time) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, time, [&] { return fresh_ || woken_; });
        woken_ = false;
        return take_locked();
    }
    void wake() {
        {
            const std::lock_guard lock(mutex_);
            woken_ = true;
        }
        changed_.notify_one();
    }
    /// The reader's own: what it took last.
    T& front() { return slots_[front_]; }

private:
    bool take_locked() {
        if (!fresh_) return false;
        std::swap(front_, middle_);
        fresh_ = false;
        return true;
    }

    std::array<T, 3> slots_{};
    std::size_t back_ = 0, middle_ = 1, front_ = 2;
    bool fresh_ = false, woken_ = false;
    std::mutex mutex_;
    std::condition_variable changed_;
};

}  // namespace cathlab::play
