// Descriptions -> pictures, each view at its own pace: the fluoroscopy with the X-ray pulses, the others as often as
// the machine allows.  On a thread of its own, or called (tests).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "imaging/image.h"
#include "play/sim_thread.h"
#include "render/frame_renderer.h"

namespace cathlab::play {

enum class View : std::size_t { fluoroscopy, inner, outer, count };
inline constexpr std::size_t view_count = static_cast<std::size_t>(View::count);

/// Pixels of each view; 0 = not wanted.
struct PaintSizes {
    std::array<int, view_count> width{}, height{};
    bool operator==(const PaintSizes&) const = default;
};

class Painter {
public:
    using MakeTarget = std::function<std::unique_ptr<GlTarget>()>;
    /// make_target is called on the thread that draws.  Throws UserError (not threaded) where there is no GL.
    Painter(TripleBuffer<Shot>& shots, bool threaded, const MakeTarget& make_target);
    ~Painter();
    Painter(const Painter&) = delete;
    Painter& operator=(const Painter&) = delete;

    void wish(const PaintSizes& sizes);
    /// Without a thread: draws what is due.
    void paint();

    /// Swaps in the newest picture of a view; false where there is none newer.  stamp: of the hands' command in it.
    bool take(View view, Image8& picture, std::uint64_t& stamp);
    /// "" or why a picture could not be drawn.
    std::string fault() const;
    /// Milliseconds that the last picture of a view took.
    double cost_ms(View view) const { return cost_ms_[static_cast<std::size_t>(view)]; }
    /// Called after each picture with the description that it was drawn from, for tests and clips.
    void set_observer(std::function<void(View, const FrameDescription&, const Image8&)> observer);

private:
    void loop(const MakeTarget& make_target);
    void paint_views(Shot& shot, bool fresh);
    void paint_view(View view, Shot& shot, const PaintSizes& sizes);

    TripleBuffer<Shot>& shots_;
    std::unique_ptr<FrameRenderer> renderer_;
    std::array<Image8, view_count> drawn_;
    std::uint64_t pulses_ = 0;
    PaintSizes painted_;
    Clock::time_point quick_painted_;
    bool threaded_ = false;

    mutable std::mutex mutex_;
    PaintSizes wished_;
    std::array<Image8, view_count> ready_;
    std::array<std::uint64_t, view_count> stamp_{};
    std::array<bool, view_count> fresh_{};
    std::string fault_;
    std::function<void(View, const FrameDescription&, const Image8&)> observer_;

    std::array<std::atomic<double>, view_count> cost_ms_{};
    std::atomic<bool> stopping_ = false;
    std::thread thread_;
};

}  // namespace cathlab::play
