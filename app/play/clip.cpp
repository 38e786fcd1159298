#include "play/clip.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/errors.h"
#include "imaging/video_writer.h"

namespace cathlab::play {
namespace {

constexpr double kept_s = 10.0;

}  // namespace

void ClipKeeper::add(const Image8& picture, double time_s) {
    const int side = std::min(picture.width, picture.height) / 2 * 2;
    if (side != side_ || (!frames_.empty() && time_s < frames_.back().time_s)) frames_.clear();
    side_ = side;
    while (!frames_.empty() && frames_.front().time_s < time_s - kept_s) frames_.pop_front();
    Frame& frame = frames_.emplace_back();
    frame.time_s = time_s;
    const auto n = static_cast<std::size_t>(side);
    frame.grey.resize(n * n);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            frame.grey[static_cast<std::size_t>(y) * n + static_cast<std::size_t>(x)] =
                picture.rgb[picture.offset(x, y)];
}

bool ClipKeeper::save(const std::string& path, double fps) {
    if (frames_.empty() || writing_.valid()) return false;
    writing_ = std::async(std::launch::async, [path, fps, frames = frames_, side = side_]() -> std::string {
        try {
            VideoWriter writer(path, side, side, fps);
            const double begin = frames.front().time_s, end = frames.back().time_s;
            const auto count = std::max<std::int64_t>(1, std::llround((end - begin) * fps) + 1);
            std::size_t at = 0;
            Image8 picture(side, side);
            for (std::int64_t i = 0; i < count; ++i) {
                const double t = begin + static_cast<double>(i) / fps + 1e-6;
                while (at + 1 < frames.size() && frames[at + 1].time_s <= t) ++at;
                for (std::size_t k = 0; k < frames[at].grey.size(); ++k)
                    std::fill_n(picture.rgb.begin() + static_cast<std::ptrdiff_t>(3 * k), 3, frames[at].grey[k]);
                writer.add(picture);
            }
            writer.close();
            return "saved " + path;
        } catch (const UserError& error) {
            return error.what();
        }
    });
    return true;
}

std::string ClipKeeper::report() {
    if (!writing_.valid() || writing_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return "";
    return writing_.get();
}

}  // namespace cathlab::play
