// Descriptions -> pictures, each view at its own pace: the fluoroscopy with the X-ray pulses, the others as often as
// the machine allows.  On two threads, so that a slow fluoroscopy keeps nothing else waiting; or called (tests).
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
#include "play/durations.h"
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
    /// make_target is called on the threads that draw; ready, on one of them, after each picture of a quick view.
    /// Throws UserError (not threaded) where there is no GL.
    Painter(Shots& shots, bool threaded, const MakeTarget& make_target, std::function<void()> ready = {});
    ~Painter();
    Painter(const Painter&) = delete;
    Painter& operator=(const Painter&) = delete;

    void wish(const PaintSizes& sizes);
    /// Without threads: draws what is due.
    void paint();

    /// Swaps in the newest picture of a view; false where there is none newer.  stamp: of the hands' command in it.
    bool take(View view, Image8& picture, std::uint64_t& stamp);
    /// Whether there is a new picture of a quick view.
    bool has_quick() const;
    /// "" or why a picture could not be drawn.
    std::string fault() const;
    /// How long the pictures of a view took so far.
    Durations cost(View view) const;
    /// Called after each picture with the description that it was drawn from, for tests and clips.
    void set_observer(std::function<void(View, const FrameDescription&, const Image8&)> observer);

private:
    // One thread and its context: of the fluoroscopy, or of the quick views.
    struct Easel {
        TripleBuffer<Shot>* shots = nullptr;
        bool exposures = false;
        std::unique_ptr<FrameRenderer> renderer;
        PaintSizes painted;
        Clock::time_point rests_until;
        std::thread thread;
    };
    void loop(Easel& easel, const MakeTarget& make_target);
    void paint(Easel& easel, bool fresh);
    void paint_view(Easel& easel, View view, Shot& shot, const PaintSizes& sizes);

    std::function<void()> ready_call_;
    std::array<Easel, 2> easels_;
    std::array<Image8, view_count> drawn_;

    mutable std::mutex mutex_;  // of what follows
    PaintSizes wished_;
    std::array<Image8, view_count> ready_;
    std::array<std::uint64_t, view_count> stamp_{};
    std::array<bool, view_count> fresh_{};
    std::array<Durations, view_count> cost_;
    std::string fault_;
    std::function<void(View, const FrameDescription&, const Image8&)> observer_;

    std::atomic<bool> stopping_ = false;
};

}  // namespace cathlab::play
