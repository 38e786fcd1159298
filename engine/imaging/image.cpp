#include "imaging/image.h"

#include <algorithm>
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

}  // namespace

void write_png(const std::string& path, const Image8& image) {
    CATHLAB_CHECK(image.width > 0 && image.height > 0, "an empty image cannot be written");
    cv::Mat bgr;
    cv::cvtColor(view_of(image), bgr, cv::COLOR_RGB2BGR);
    std::vector<std::uint8_t> bytes;
    CATHLAB_CHECK(cv::imencode(".png", bgr, bytes, {cv::IMWRITE_PNG_COMPRESSION, 4}), "PNG encoder failed");

    const std::string part = path + ".part";
    std::error_code ignored;
    {
        std::ofstream file(part, std::ios::binary | std::ios::trunc);
        if (!file) throw UserError("cannot write '" + path + "': the folder is missing or not writable");
        file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
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
