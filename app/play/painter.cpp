#include "play/painter.h"

#include <sys/resource.h>

#include <utility>

namespace cathlab::play {
namespace {

constexpr double quick_view_s = 1.0 / 40.0;  // the views without X-rays come at most so often

constexpr int painter_niceness = 10;

}  // namespace

Painter::Painter(TripleBuffer<Shot>& shots, bool threaded, const MakeTarget& make_target)
    : shots_(shots), threaded_(threaded) {
    if (threaded)
        thread_ = std::thread([this, make_target] { loop(make_target); });
    else
        renderer_ = std::make_unique<FrameRenderer>(make_target());
}

Painter::~Painter() {
    stopping_ = true;
    shots_.wake();
    if (thread_.joinable()) thread_.join();
}

void Painter::loop(const MakeTarget& make_target) {
    // On Linux this is the thread's own: where processors are short, pictures wait and the simulation does not.
    ::setpriority(PRIO_PROCESS, 0, painter_niceness);
    try {
        renderer_ = std::make_unique<FrameRenderer>(make_target());
        while (!stopping_) {
            const bool fresh = shots_.take_within(std::chrono::milliseconds(50));
            if (!stopping_) paint_views(shots_.front(), fresh);
        }
    } catch (const std::exception& error) {
        const std::lock_guard lock(mutex_);
        fault_ = error.what();
    }
    renderer_.reset();  // where its context is current
}

void Painter::paint() {
    const bool fresh = shots_.take();
    paint_views(shots_.front(), fresh);
}

void Painter::wish(const PaintSizes& sizes) {
    const std::lock_guard lock(mutex_);
    wished_ = sizes;
}

void Painter::paint_views(Shot& shot, bool fresh) {
    PaintSizes sizes;
    {
        const std::lock_guard lock(mutex_);
        sizes = wished_;
    }
    if (shot.picture.lumen.vertices.empty()) return;  // nothing was published yet
    const bool resized = !(sizes == painted_);
    if (!fresh && !resized) return;
    painted_ = sizes;
    const bool paced =
        threaded_ && !resized && std::chrono::duration<double>(Clock::now() - quick_painted_).count() < quick_view_s;
    if (!paced) {
        paint_view(View::inner, shot, sizes);
        paint_view(View::outer, shot, sizes);
        quick_painted_ = Clock::now();
    }
    // Between the pulses, and while the pedal is up, the last picture stands.
    if (shot.pulses != pulses_ && shot.picture.beam_on) {
        pulses_ = shot.pulses;
        paint_view(View::fluoroscopy, shot, sizes);
    }
}

void Painter::paint_view(View view, Shot& shot, const PaintSizes& sizes) {
    const auto i = static_cast<std::size_t>(view);
    if (sizes.width[i] < 64 || sizes.height[i] < 64) return;
    FrameDescription& frame = shot.picture;
    frame.width = sizes.width[i];
    frame.height = sizes.height[i];
    frame.show_fluoroscopy = view == View::fluoroscopy;
    frame.show_inner_view = view == View::inner;
    frame.show_outer_view = view == View::outer;
    frame.overlay = {};
    const auto begin = Clock::now();
    try {
        renderer_->render(frame, drawn_[i]);
    } catch (const std::exception& error) {  // one picture is lost, not the session
        const std::lock_guard lock(mutex_);
        fault_ = std::string("a picture could not be drawn: ") + error.what();
        return;
    }
    cost_ms_[i] = 1e3 * std::chrono::duration<double>(Clock::now() - begin).count();
    const std::lock_guard lock(mutex_);
    if (observer_) observer_(view, frame, drawn_[i]);
    std::swap(ready_[i], drawn_[i]);
    stamp_[i] = shot.stamp;
    fresh_[i] = true;
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

std::string Painter::fault() const {
    const std::lock_guard lock(mutex_);
    return fault_;
}

void Painter::set_observer(std::function<void(View, const FrameDescription&, const Image8&)> observer) {
    const std::lock_guard lock(mutex_);
    observer_ = std::move(observer);
}

}  // namespace cathlab::play
