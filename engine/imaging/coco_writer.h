// Labels of a film's pictures in COCO's format [lin2014], one json file.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cathlab {

/// A mask as COCO packs it: runs of 0 and 1 in turn, beginning with 0, column by column, as text.
struct CocoMask {
    std::string counts;
    std::int64_t area = 0;                  ///< pixels
    std::array<int, 4> box = {0, 0, 0, 0};  ///< x, y, width, height
};

/// inside: width x height bytes of 0 or 1, rows from the top.  The mask is placed with its upper left corner at (x, y)
/// of a picture of picture_width x picture_height; what lies outside is left away.
CocoMask coco_mask(std::span<const std::uint8_t> inside, int width, int height, int x, int y, int picture_width,
                   int picture_height);

/// The mask back, (picture_width x picture_height) bytes, rows from the top.  For tests and readers.
std::vector<std::uint8_t> read_coco_mask(const std::string& counts, int picture_width, int picture_height);

struct CocoImage {
    std::string file_name;  ///< of the picture or of the film
    int width = 0, height = 0;
    std::string facts;  ///< a json object whose members the image gets too, or ""
};

struct CocoAnnotation {
    std::string category;
    CocoMask mask;
    std::string facts;  ///< as above
};

struct CocoKeyPoint {
    double x = 0, y = 0;
    int visibility = 0;  ///< 0 outside, 1 not to be seen, 2 seen
};

/// Writes PATH.part annotation by annotation and renames it in close(): the file is whole or it is not there.
class CocoWriter {
public:
    /// categories: (name, supercategory), the same for the whole film; one more, "scene", holds the key points.
    /// Throws UserError where the folder is missing, unwritable or full; so do the others.
    CocoWriter(const std::string& path, const std::string& description,
               const std::vector<std::pair<std::string, std::string>>& categories,
               const std::vector<std::string>& key_point_names);
    /// Without close() before it: given up, and the part file removed.
    ~CocoWriter();
    CocoWriter(const CocoWriter&) = delete;
    CocoWriter& operator=(const CocoWriter&) = delete;

    /// The next picture.  key_points in the order of their names; empty masks are left away.
    void add(const CocoImage& image, const std::vector<CocoAnnotation>& annotations,
             const std::vector<CocoKeyPoint>& key_points);
    void close();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace cathlab
