// Pictures as plain arrays: what the renderer makes, the video takes and the tests compare.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cathlab {

/// Eight-bit RGB, rows from the top, no padding: byte 3 * (y * width + x) is the red of pixel (x, y).
struct Image8 {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;

    Image8() = default;
    Image8(int w, int h, std::uint8_t value = 0)
        : width(w), height(h), rgb(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value) {}
    std::size_t offset(int x, int y) const {
        return 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    }
};

/// One float a pixel, rows from the top (path lengths in mm, intensities relative to the unattenuated beam, ...).
struct ImageF {
    int width = 0;
    int height = 0;
    std::vector<float> values;

    ImageF() = default;
    ImageF(int w, int h, float value = 0.0F)
        : width(w), height(h), values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value) {}
    std::size_t offset(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    float at(int x, int y) const { return values[offset(x, y)]; }
};

/// Writes a PNG beside `path` and renames it: the file is whole or it is not there.
/// Throws UserError where the folder is missing, unwritable or full.
void write_png(const std::string& path, const Image8& image);

/// One channel of 16 bits: round(scale * value), 0 to 65535.  Throws as write_png.
void write_png16(const std::string& path, const ImageF& image, double scale);

/// The values as they are: 32-bit floats, little endian, rows from the top, nothing else.  Throws as write_png.
void write_floats(const std::string& path, const ImageF& image);

/// Reads any PNG as RGB; throws UserError where the file is missing or not a PNG.
Image8 read_png(const std::string& path);

/// Copies `part` into `whole` with its top left corner at (x, y); what lies outside is left away.
void paste(Image8& whole, const Image8& part, int x, int y);

/// A copy of another size (mean over the area where it shrinks, bilinear where it grows); width and height > 0.
Image8 resized(const Image8& image, int width, int height);

}  // namespace cathlab
