#include "play/painter.h"

#include <sys/resource.h>

#include <algorithm>
#include <utility>

namespace cathlab::play {
namespace {

constexpr double quick_rest = 0.5;  // after a quick view it rests for this share of what the view took

// Where processors are short, pictures wait and the simulation does not: the fluoroscopy first, which is only due with
// the X-ray pulses.
constexpr int fluoroscopy_niceness = 5, quick_niceness = 1;

double since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace

Painter::Painter(Shots& shots, bool threaded, const MakeTarget& make_target, std::function<void()> ready)
    : ready_call_(std::move(ready)) {
    easels_[0].shots = &shots.newest;
    easels_[1].shots = &shots.exposures;
    easels_[1].exposures = true;
    for (Easel& easel : easels_) {
        if (threaded)
            easel.thread = std::thread([this, &easel, make_target] { loop(easel, make_target); });
        else
            easel.renderer = std::make_unique<FrameRenderer>(make_target());
    }
}

Painter::~Painter() {
    stopping_ = true;
    for (Easel& easel : easels_) {
        easel.shots->wake();
        if (easel.thread.joinable()) easel.thread.join();
    }
}

void Painter::loop(Easel& easel, const MakeTarget& make_target) {
    // On Linux this is the thread's own.
    const int niceness = ::getpriority(PRIO_PROCESS, 0) + (easel.exposures ? fluoroscopy_niceness : quick_niceness);
    ::setpriority(PRIO_PROCESS, 0, niceness);
    try {
        easel.renderer = std::make_unique<FrameRenderer>(make_target());
        while (!stopping_) {
            std::this_thread::sleep_until(easel.rests_until);
            const bool fresh = easel.shots->take_within(std::chrono::milliseconds(50));
            if (!stopping_) paint(easel, fresh);
        }
    } catch (const std::exception& error) {
        const std::lock_guard lock(mutex_);
        fault_ = error.what();
    }
    easel.renderer.reset();  // where its context is current
}

void Painter::paint() {
    for (Easel& easel : easels_) paint(easel, easel.shots->take());
}

void Painter::wish(const PaintSizes& sizes) {
    const std::lock_guard lock(mutex_);
    wished_ = sizes;
}

void Painter::paint(Easel& easel, bool fresh) {
    Shot& shot = easel.shots->front();
    PaintSizes sizes;
    {
        const std::lock_guard lock(mutex_);
        sizes = wished_;
    }
    if (shot.picture.lumen.vertices.empty()) return;  // nothing was published yet
    if (easel.exposures) {
        // Between the pulses, and while the pedal is up, the last picture stands.
        if (fresh) paint_view(easel, View::fluoroscopy, shot, sizes);
        return;
    }
    if (!fresh && sizes == easel.painted) return;
    easel.painted = sizes;
    const auto begin = Clock::now();
    paint_view(easel, View::inner, shot, sizes);
    paint_view(easel, View::outer, shot, sizes);
    const auto end = Clock::now();
    easel.rests_until = end + std::chrono::duration_cast<Clock::duration>(quick_rest * (end - begin));
}

void Painter::paint_view(Easel& easel, View view, Shot& shot, const PaintSizes& sizes) {
    const auto i = static_cast<std::size_t>(view);
    if (sizes.width[i] < 64 || sizes.height[i] < 64) return;
    FrameDescription& frame = shot.picture;
    frame.width = sizes.width[i];
    frame.height = sizes.height[i];
    frame.show_fluoroscopy = view == View::fluoroscopy;
    frame.show_inner_view = view == View::inner;
    frame.show_outer_view = view == View::outer;
    frame.show_reference = false;  // the window keeps its own
    frame.overlay = {};
    const auto begin = Clock::now();
    try {
        easel.renderer->render(frame, drawn_[i]);
    } catch (const std::exception& error) {  // one picture is lost, not the session
        const std::lock_guard lock(mutex_);
        fault_ = std::string("a picture could not be drawn: ") + error.what();
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        cost_[i].add(since(begin));
        if (observer_) observer_(view, frame, drawn_[i]);
        std::swap(ready_[i], drawn_[i]);
        stamp_[i] = shot.stamp;
        fresh_[i] = true;
    }
    if (!easel.exposures && ready_call_) ready_call_();
}

bool Painter::take(View view, Image8& picture, std::uint64_t& stamp) {
    const auto i = static_cast<std::size_t>(view);
    const std::lock_guard lock(mutex_);
    if (!fresh_[i]) return false;
    fresh_[i] = false;
    std::swap(picture, ready_[i]);
    stamp = stamp_[i];
    return true;
}

bool Painter::has_quick() const {
    const std::lock_guard lock(mutex_);
    return fresh_[static_cast<std::size_t>(View::inner)] || fresh_[static_cast<std::size_t>(View::outer)];
}

std::string Painter::fault() const {
    const std::lock_guard lock(mutex_);
    return fault_;
}

Durations Painter::cost(View view) const {
    const std::lock_guard lock(mutex_);
    return cost_[static_cast<std::size_t>(view)];
}

void Painter::set_observer(std::function<void(View, const FrameDescription&, const Image8&)> observer) {
    const std::lock_guard lock(mutex_);
    observer_ = std::move(observer);
}

}  // namespace cathlab::play
