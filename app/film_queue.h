// Descriptions of frames on their way from the step to the studio.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "studio.h"

namespace cathlab {

/// A ring of frame descriptions with a studio at its end, on this thread or on one of its own.  Descriptions are used
/// again and again, so that their vectors keep their memory and their meshes are copied once.
/// One thread calls; what stops the studio is thrown by every later call.
class FilmQueue {
public:
    /// threads > 0: the studio is made, used and let go on a thread of its own, up to `slots` pictures behind; of two,
    /// it has the second for its encoder.  Throws what Studio's constructor throws.
    FilmQueue(const FilmOptions& options, int threads, std::size_t slots);
    ~FilmQueue();
    FilmQueue(const FilmQueue&) = delete;
    FilmQueue& operator=(const FilmQueue&) = delete;

    /// A free description to fill; waits for one.  It holds what an earlier frame left in it.
    FilmFrame& next();
    /// The description that next() gave is filled.
    void submit();
    /// The picture of the last submit() becomes the poster.
    void keep_poster();
    /// Waits for all that was submitted; the poster, or the last picture.
    Image8 poster();
    bool failed() const;
    /// Waits for all that was submitted, then closes the film.
    void close();

private:
    void work(const FilmOptions& options, bool encode_apart);
    void draw(std::size_t slot);
    void guarded(const std::function<void()>& job);
    void wait(std::unique_lock<std::mutex>& lock, const std::function<bool()>& ready);
    void stop();

    std::vector<FilmFrame> slots_;
    std::unique_ptr<Studio> studio_;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::size_t submitted_ = 0, drawn_ = 0,
                poster_of_ = 0;  // frames counted from 1; frame n lies in slot (n - 1) % size
    Image8 poster_;
    bool opened_ = false, closing_ = false, giving_up_ = false;
    std::exception_ptr failure_;
    std::thread thread_;
};

}  // namespace cathlab
