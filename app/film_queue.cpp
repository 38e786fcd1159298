#include "film_queue.h"

namespace cathlab {

FilmQueue::FilmQueue(const FilmOptions& options, int threads, std::size_t slots) : slots_(threads > 0 ? slots : 1) {
    if (threads == 0) {
        studio_ = std::make_unique<Studio>(options, false);
        return;
    }
    thread_ = std::thread([this, options, threads] { work(options, threads > 1); });
    try {
        std::unique_lock lock(mutex_);
        wait(lock, [&] { return opened_; });
    } catch (...) {
        stop();
        throw;
    }
}

FilmQueue::~FilmQueue() {
    stop();
}

void FilmQueue::stop() {
    if (!thread_.joinable()) return;
    {
        const std::scoped_lock lock(mutex_);
        giving_up_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

// What the studio throws waits here for the caller's next call.
void FilmQueue::guarded(const std::function<void()>& job) {
    try {
        job();
    } catch (...) {
        const std::scoped_lock lock(mutex_);
        failure_ = std::current_exception();
    }
}

void FilmQueue::wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& ready) {
    changed_.wait(lock, [&] { return failure_ || ready(); });
    if (failure_) std::rethrow_exception(failure_);
}

FilmFrame& FilmQueue::next() {
    std::unique_lock lock(mutex_);
    wait(lock, [&] { return submitted_ - drawn_ < slots_.size(); });
    return slots_[submitted_ % slots_.size()];
}

void FilmQueue::submit() {
    std::unique_lock lock(mutex_);
    ++submitted_;
    lock.unlock();
    if (thread_.joinable()) {
        changed_.notify_all();
        return;
    }
    guarded([&] { draw(drawn_ % slots_.size()); });
    lock.lock();
    wait(lock, [] { return true; });
}

void FilmQueue::draw(std::size_t slot) {
    studio_->add(slots_[slot]);
    const std::scoped_lock lock(mutex_);
    ++drawn_;
    if (poster_of_ == drawn_) poster_ = studio_->last();
}

void FilmQueue::keep_poster() {
    const std::scoped_lock lock(mutex_);
    poster_of_ = submitted_;
    // Nothing under way: the studio's last picture is the one.  Else it will be kept as soon as it is drawn.
    if (studio_ && drawn_ == submitted_) poster_ = studio_->last();
}

Image8 FilmQueue::poster() {
    std::unique_lock lock(mutex_);
    wait(lock, [&] { return drawn_ == submitted_; });
    return poster_.rgb.empty() ? studio_->last() : poster_;
}

bool FilmQueue::failed() const {
    const std::scoped_lock lock(mutex_);
    return failure_ != nullptr;
}

void FilmQueue::close() {
    if (!thread_.joinable()) {
        guarded([&] {
            if (!failure_) studio_->close();
        });
    } else {
        {
            const std::scoped_lock lock(mutex_);
            closing_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }
    if (failure_) std::rethrow_exception(failure_);
}

void FilmQueue::work(const FilmOptions& options, bool encode_apart) {
    guarded([&] {
        auto studio = std::make_unique<Studio>(options, encode_apart);
        std::unique_lock lock(mutex_);
        studio_ = std::move(studio);
        opened_ = true;
        changed_.notify_all();
        for (;;) {
            changed_.wait(lock, [&] { return giving_up_ || closing_ || drawn_ < submitted_; });
            if (giving_up_ || drawn_ == submitted_) break;
            const std::size_t slot = drawn_ % slots_.size();
            lock.unlock();
            draw(slot);
            changed_.notify_all();
            lock.lock();
        }
        const bool finish = !giving_up_;
        lock.unlock();
        if (finish) studio_->close();
    });
    changed_.notify_all();
    // The GL context goes where it was made.  Nobody looks at the studio any more: the caller either waits in close(),
    // or gives up, or finds the failure first.
    const std::scoped_lock lock(mutex_);
    studio_.reset();
}

}  // namespace cathlab
