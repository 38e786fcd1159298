// sphere_error_map FILE: the drawn path lengths of a sphere of about 20,000 triangles less its chords, as a picture
// with its scale.  For docs/fluoroscopy.md; what the errors must be is tests/render/path_lengths_test.cpp's business.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <opencv2/imgproc.hpp>

#include "imaging/image.h"
#include "render/path_raster.h"
#include "render/projection.h"
#include "render/scene.h"

namespace cathlab {
namespace {

constexpr int side = 384, bar_width = 112;
constexpr double radius_mm = 40.0, full_scale = 2e-3;  // of the diameter

// White at 0; red too long, blue too short.
std::array<std::uint8_t, 3> colour(double share) {
    const double v = std::clamp(share / full_scale, -1.0, 1.0);
    const auto fade = static_cast<std::uint8_t>(std::lround(255.0 * (1.0 - std::fabs(v))));
    const auto half = static_cast<std::uint8_t>(std::lround(255.0 - 95.0 * std::fabs(v)));
    return v > 0 ? std::array<std::uint8_t, 3>{half, fade, fade} : std::array<std::uint8_t, 3>{fade, fade, half};
}

void write(cv::Mat& on, const char* text, int x, int y) {
    cv::putText(on, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.4, {20, 20, 20}, 1, cv::LINE_AA);
}

void draw(const char* path) {
    const Vec3 center(0, 0, 0);
    const CArmView view{.width_mm = 150.0, .height_mm = 150.0};
    const Projection projection(view, side, side);
    const TriMesh mesh = testing_shapes::sphere(center, radius_mm, 70);
    PathRaster raster;
    PathLengths drawn;
    raster.draw(projection, mesh.vertices, mesh.triangles, {}, drawn);

    Image8 picture(side + bar_width, side, 235);
    double sum = 0.0, largest = 0.0;
    int count = 0;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const Vec3 d = projection.ray(x + 0.5, y + 0.5), from = projection.source() - center;
            const double middle = -from.dot(d);
            const double half = radius_mm * radius_mm - (from + middle * d).squaredNorm();
            const double truth = half > 0 ? 2.0 * std::sqrt(half) : 0.0;
            const double length = drawn.length_mm.at(x, y);
            if (truth <= 0 && length <= 0) continue;
            const double error = (length - truth) / (2.0 * radius_mm);
            const auto rgb = colour(error);
            std::copy(rgb.begin(), rgb.end(), picture.rgb.begin() + static_cast<std::ptrdiff_t>(picture.offset(x, y)));
            sum += std::fabs(error);
            largest = std::max(largest, std::fabs(error));
            ++count;
        }
    }
    constexpr int top = 60, bottom = side - 60, left = side + 8, right = side + 30;
    for (int y = top; y < bottom; ++y) {
        const auto rgb = colour(full_scale * (1.0 - 2.0 * (y - top) / (bottom - 1.0 - top)));
        for (int x = left; x < right; ++x)
            std::copy(rgb.begin(), rgb.end(), picture.rgb.begin() + static_cast<std::ptrdiff_t>(picture.offset(x, y)));
    }
    cv::Mat on(picture.height, picture.width, CV_8UC3, picture.rgb.data());
    std::array<char, 64> text{};
    for (int k = -2; k <= 2; ++k) {
        const int y = (top + bottom) / 2 - k * (bottom - top) / 4;
        cv::line(on, {right, y}, {right + 4, y}, {20, 20, 20});
        std::snprintf(text.data(), text.size(), "%+.1f %%", 50.0 * k * full_scale);
        write(on, k == 0 ? "0" : text.data(), right + 8, y + 4);
    }
    write(on, "drawn - chord,", side - 4, 24);
    write(on, "of 80 mm", side - 4, 40);
    std::snprintf(text.data(), text.size(), "mean %.3f %%", 100.0 * sum / count);
    write(on, text.data(), side - 4, side - 30);
    std::snprintf(text.data(), text.size(), "largest %.1f %%", 100.0 * largest);
    write(on, text.data(), side - 4, side - 14);
    write_png(path, picture);
    std::printf("%zu triangles: |drawn - chord| / diameter: mean %.4f %%, largest %.2f %%; %zu open rays\n",
                mesh.triangles.size(), 100.0 * sum / count, 100.0 * largest, drawn.bad_pixels);
}

}  // namespace
}  // namespace cathlab

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: sphere_error_map FILE.png\n");
        return 2;
    }
    try {
        cathlab::draw(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
