#include "imaging/video_writer.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <optional>

#include "core/check.h"
#include "core/errors.h"
#include "core/log.h"
#include "imaging/film_codec.h"
#include "imaging/libav_encoder.h"

namespace cathlab {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t least_free_bytes = 4 << 20;  // a folder with less than this is full for a film

std::string part_name(const fs::path& path) {
    fs::path part = path;
    part.replace_extension();
    part += ".part";
    part += path.extension();
    return part.string();
}

void require_writable(const std::string& path, const std::string& part) {
    const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
    if (!fs::is_directory(folder)) throw UserError("cannot write video '" + path + "': no folder " + folder.string());
    std::error_code error;
    const bool writable = static_cast<bool>(std::ofstream(part, std::ios::binary));
    fs::remove(part, error);
    if (!writable) throw UserError("cannot write video '" + path + "': " + folder.string() + " is not writable");
    const fs::space_info space = fs::space(folder, error);
    if (!error && space.available < least_free_bytes)
        throw UserError("cannot write video '" + path + "': the disk is full (" +
                        std::to_string(space.available >> 10) + " kB are free, " +
                        std::to_string(least_free_bytes >> 20) + " MB are wanted)");
}

}  // namespace

struct VideoWriter::Impl {
    std::string path, part, codec;
    int width = 0, height = 0;
    std::size_t added = 0;
    bool closed = false;
    std::optional<LibavEncoder> writer;

    void open(FilmCodec wanted, const char* name, double fps) {
        codec = name;
        try {
            writer.emplace(part, wanted, width, height, fps);
        } catch (const std::runtime_error& error) {
            drop_part();
            throw UserError("cannot write video '" + path + "': " + error.what());
        }
    }

    void drop_part() const {
        std::error_code ignored;
        fs::remove(part, ignored);
    }
};

VideoWriter::VideoWriter(const std::string& path, int width, int height, double fps, const std::string& codec)
    : impl_(std::make_unique<Impl>()) {
    const std::string extension = fs::path(path).extension().string();
    if (extension != ".mp4" && extension != ".avi") {
        throw UserError("cannot write video '" + path + "': its name must end in .mp4 (H.264) or .avi (lossless FFV1)");
    }
    if (width < 16 || height < 16 || width % 2 != 0 || height % 2 != 0) {
        throw UserError("a video of " + std::to_string(width) + "x" + std::to_string(height) +
                        " cannot be written: width and height must be even numbers of at least 16");
    }
    if (!(fps > 0.0 && fps <= 240.0)) {
        throw UserError("a video with " + std::to_string(fps) +
                        " frames per second cannot be written: allowed is (0, 240]");
    }
    const FilmCodec chosen = choose_codec(path, extension, codec, LibavEncoder::knows);
    impl_->path = path;
    impl_->part = part_name(path);
    impl_->width = width;
    impl_->height = height;
    require_writable(path, impl_->part);
    if (chosen == FilmCodec::mpeg4 && codec.empty())
        log::warn("no H.264 encoder here; '" + path + "' is written as MPEG-4 part 2 (mp4v)");
    switch (chosen) {
        case FilmCodec::lossless: impl_->open(chosen, "FFV1", fps); break;
        case FilmCodec::h264: impl_->open(chosen, "avc1", fps); break;
        case FilmCodec::mpeg4: impl_->open(chosen, "mp4v", fps); break;
    }
}

VideoWriter::~VideoWriter() {
    if (impl_->closed) return;
    impl_->writer.reset();
    impl_->drop_part();
}

void VideoWriter::add(const Image8& frame) {
    CATHLAB_CHECK(!impl_->closed, "the film is closed");
    CATHLAB_CHECK(frame.width == impl_->width && frame.height == impl_->height,
                  "a frame's size differs from the film's");
    try {
        impl_->writer->write(frame);
    } catch (const std::runtime_error& error) {
        throw UserError("video '" + impl_->path + "' cannot go on: " + error.what());
    }
    ++impl_->added;
}

void VideoWriter::close() {
    if (impl_->closed) return;
    impl_->closed = true;
    try {
        if (impl_->added == 0) throw UserError("video '" + impl_->path + "' has no frame and was not written");
        try {
            impl_->writer->finish();
        } catch (const std::runtime_error& error) {
            throw UserError("video '" + impl_->path + "' failed: " + error.what());
        }
        impl_->writer.reset();
        const VideoFacts facts = read_video_facts(impl_->part);
        if (facts.frames != impl_->added || facts.width != impl_->width || facts.height != impl_->height) {
            throw UserError("video '" + impl_->path + "' reads back as " + std::to_string(facts.frames) +
                            " frames of " + std::to_string(facts.width) + "x" + std::to_string(facts.height) +
                            ", written were " + std::to_string(impl_->added) + " of " + std::to_string(impl_->width) +
                            "x" + std::to_string(impl_->height) + "; the disk may be full");
        }
        std::error_code error;
        fs::rename(impl_->part, impl_->path, error);
        if (error) throw UserError("cannot write video '" + impl_->path + "': " + error.message());
    } catch (...) {
        impl_->writer.reset();
        impl_->drop_part();
        throw;
    }
}

std::size_t VideoWriter::frames() const {
    return impl_->added;
}
const std::string& VideoWriter::codec() const {
    return impl_->codec;
}

Image8 read_video_frame(const std::string& path, std::size_t index) {
    cv::VideoCapture capture;
    if (!fs::is_regular_file(path) || !capture.open(path, cv::CAP_FFMPEG)) {
        throw UserError("cannot read video '" + path + "'");
    }
    cv::Mat bgr;
    for (std::size_t i = 0; i <= index; ++i) {
        if (!capture.grab()) throw UserError("video '" + path + "' has no frame " + std::to_string(index));
    }
    capture.retrieve(bgr);
    Image8 image(bgr.cols, bgr.rows);
    cv::Mat rgb(bgr.rows, bgr.cols, CV_8UC3, image.rgb.data());
    cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
    return image;
}

}  // namespace cathlab
