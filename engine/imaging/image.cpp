#include "imaging/image.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <system_error>

#include "core/check.h"
#include "core/errors.h"

namespace cathlab {

namespace {

// OpenCV only reads from it, though its type does not say so.
cv::Mat view_of(const Image8& image) {
    return {image.height, image.width, CV_8UC3, const_cast<std::uint8_t*>(image.rgb.data())};
}

Image8 copy_of(const cv::Mat& rgb) {
    Image8 image(rgb.cols, rgb.rows);
    const std::size_t row = 3 * static_cast<std::size_t>(rgb.cols);
    for (int y = 0; y < rgb.rows; ++y) {
        std::memcpy(image.rgb.data() + row * static_cast<std::size_t>(y), rgb.ptr(y), row);
    }
    return image;
}

void write_whole(const std::string& path, const void* data, std::size_t size) {
    const std::string part = path + ".part";
    std::error_code ignored;
    {
        std::ofstream file(part, std::ios::binary | std::ios::trunc);
        if (!file) throw UserError("cannot write '" + path + "': the folder is missing or not writable");
        file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
        file.flush();
        if (!file) {
            file.close();
            std::filesystem::remove(part, ignored);
            throw UserError("cannot write '" + path + "': the disk is full or the file cannot be written");
        }
    }
    std::error_code error;
    std::filesystem::rename(part, path, error);
    if (error) {
        std::filesystem::remove(part, ignored);
        throw UserError("cannot write '" + path + "': " + error.message());
    }
}

void write_encoded(const std::string& path, const cv::Mat& picture) {
    std::vector<std::uint8_t> bytes;
    CATHLAB_CHECK(cv::imencode(".png", picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 4}), "PNG encoder failed");
    write_whole(path, bytes.data(), bytes.size());
}

}  // namespace

void write_png(const std::string& path, const Image8& image) {
    CATHLAB_CHECK(image.width > 0 && image.height > 0, "an empty image cannot be written");
    cv::Mat bgr;
    cv::cvtColor(view_of(image), bgr, cv::COLOR_RGB2BGR);
    write_encoded(path, bgr);
}

void write_png16(const std::string& path, const ImageF& image, double scale) {
    CATHLAB_CHECK(image.width > 0 && image.height > 0, "an empty image cannot be written");
    cv::Mat grey(image.height, image.width, CV_16UC1);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x)
            grey.at<std::uint16_t>(y, x) =
                static_cast<std::uint16_t>(std::clamp(std::lround(scale * image.at(x, y)), 0L, 65535L));
    }
    write_encoded(path, grey);
}

void write_floats(const std::string& path, const ImageF& image) {
    static_assert(std::endian::native == std::endian::little);
    write_whole(path, image.values.data(), image.values.size() * sizeof(float));
}

Image8 read_png(const std::string& path) {
    if (!std::filesystem::is_regular_file(path)) throw UserError("cannot read '" + path + "': no such file");
    const cv::Mat bgr = cv::imread(path, cv::IMREAD_COLOR);
    if (bgr.empty()) throw UserError("cannot read '" + path + "': it is not a picture that can be decoded");
    cv::Mat rgb;
    cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
    return copy_of(rgb);
}

void paste(Image8& whole, const Image8& part, int x, int y) {
    const int x0 = std::max(0, x);
    const int x1 = std::min(whole.width, x + part.width);
    if (x0 >= x1) return;
    for (int row = std::max(0, y); row < std::min(whole.height, y + part.height); ++row) {
        std::memcpy(whole.rgb.data() + whole.offset(x0, row), part.rgb.data() + part.offset(x0 - x, row - y),
                    3 * static_cast<std::size_t>(x1 - x0));
    }
}

Image8 resized(const Image8& image, int width, int height) {
    CATHLAB_CHECK(width > 0 && height > 0 && image.width > 0 && image.height > 0, "sizes must be positive");
    cv::Mat out;
    const bool shrinks = width < image.width || height < image.height;
    cv::resize(view_of(image), out, {width, height}, 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
    return copy_of(out);
}

}  // namespace cathlab
