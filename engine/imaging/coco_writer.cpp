#include "imaging/coco_writer.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/check.h"
#include "core/errors.h"

namespace cathlab {

namespace {

using Json = nlohmann::ordered_json;

// COCO's text for run lengths: from the third run on the difference to the run before the last, five bits a character
// with a sixth that says whether more follow, from '0' on.
std::string packed(const std::vector<std::int64_t>& runs) {
    std::string text;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        std::int64_t x = i > 2 ? runs[i] - runs[i - 2] : runs[i];
        for (bool more = true; more;) {
            std::int64_t bits = x & 0x1F;
            x >>= 5;
            more = (bits & 0x10) != 0 ? x != -1 : x != 0;
            if (more) bits |= 0x20;
            text += static_cast<char>(bits + 48);
        }
    }
    return text;
}

std::vector<std::int64_t> unpacked(const std::string& text) {
    std::vector<std::int64_t> runs;
    for (std::size_t i = 0; i < text.size();) {
        std::int64_t x = 0;
        int shift = 0;
        for (bool more = true; more && i < text.size(); ++i, shift += 5) {
            const std::int64_t bits = text[i] - 48;
            x |= (bits & 0x1F) << shift;
            more = (bits & 0x20) != 0;
            if (!more && (bits & 0x10) != 0) x |= -1LL * (1LL << (shift + 5));
        }
        if (runs.size() > 2) x += runs[runs.size() - 2];
        runs.push_back(x);
    }
    return runs;
}

double rounded(double v) {
    return std::round(v * 1000.0) / 1000.0;
}

void merge(Json& object, const std::string& facts) {
    if (facts.empty()) return;
    const Json more = Json::parse(facts);
    for (const auto& [key, value] : more.items()) object[key] = value;
}

}  // namespace

CocoMask coco_mask(std::span<const std::uint8_t> inside, int width, int height, int x, int y, int picture_width,
                   int picture_height) {
    CATHLAB_CHECK(inside.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                  "one byte a pixel of the mask");
    CocoMask out;
    std::vector<std::int64_t> runs;
    std::int64_t run = 0;
    bool now = false;
    int left = picture_width, right = -1, top = picture_height, bottom = -1;
    for (int column = 0; column < picture_width; ++column) {
        const int from = column - x;
        if (from < 0 || from >= width) {  // a whole column of nothing
            if (now) {
                runs.push_back(run);
                run = 0;
                now = false;
            }
            run += picture_height;
            continue;
        }
        for (int row = 0; row < picture_height; ++row) {
            const int line = row - y;
            const bool in = line >= 0 && line < height &&
                            inside[static_cast<std::size_t>(line) * static_cast<std::size_t>(width) +
                                   static_cast<std::size_t>(from)] != 0;
            if (in != now) {
                runs.push_back(run);
                run = 0;
                now = in;
            }
            ++run;
            if (!in) continue;
            ++out.area;
            left = std::min(left, column);
            right = std::max(right, column);
            top = std::min(top, row);
            bottom = std::max(bottom, row);
        }
    }
    runs.push_back(run);
    out.counts = packed(runs);
    if (out.area > 0) out.box = {left, top, right - left + 1, bottom - top + 1};
    return out;
}

std::vector<std::uint8_t> read_coco_mask(const std::string& counts, int picture_width, int picture_height) {
    const std::size_t width = static_cast<std::size_t>(picture_width),
                      height = static_cast<std::size_t>(picture_height);
    std::vector<std::uint8_t> out(width * height);
    std::size_t place = 0;
    bool in = false;
    for (const std::int64_t run : unpacked(counts)) {
        for (std::int64_t i = 0; i < run && place < out.size(); ++i, ++place)
            out[(place % height) * width + place / height] = in ? 1 : 0;
        in = !in;
    }
    return out;
}

struct CocoWriter::Impl {
    std::string path, part;
    std::ofstream file;
    std::map<std::string, int> category_ids;
    Json categories = Json::array(), images = Json::array();
    std::string description;
    int scene_id = 0;
    std::int64_t annotations = 0;

    void write(const std::string& text) {
        file << text;
        if (!file) throw UserError("cannot write '" + path + "': the disk is full or the file cannot be written");
    }
    void annotation(Json& object) {
        object["id"] = ++annotations;
        write((annotations > 1 ? ",\n" : "\n") + object.dump());
    }
};

CocoWriter::CocoWriter(const std::string& path, const std::string& description,
                       const std::vector<std::pair<std::string, std::string>>& categories,
                       const std::vector<std::string>& key_point_names)
    : impl_(std::make_unique<Impl>()) {
    Impl& m = *impl_;
    m.path = path;
    m.part = path + ".part";
    m.description = description;
    int id = 0;
    for (const auto& [name, above] : categories) {
        m.category_ids[name] = ++id;
        m.categories.push_back({{"id", id}, {"name", name}, {"supercategory", above}});
    }
    m.scene_id = ++id;
    m.categories.push_back({{"id", id},
                            {"name", "scene"},
                            {"supercategory", "scene"},
                            {"keypoints", key_point_names},
                            {"skeleton", Json::array()}});
    m.file.open(m.part, std::ios::binary | std::ios::trunc);
    if (!m.file) throw UserError("cannot write '" + path + "': the folder is missing or not writable");
    m.write("{\"annotations\": [");
}

CocoWriter::~CocoWriter() {
    if (!impl_->file.is_open()) return;
    impl_->file.close();
    std::error_code ignored;
    std::filesystem::remove(impl_->part, ignored);
}

void CocoWriter::add(const CocoImage& image, const std::vector<CocoAnnotation>& annotations,
                     const std::vector<CocoKeyPoint>& key_points) {
    Impl& m = *impl_;
    const auto id = static_cast<std::int64_t>(m.images.size()) + 1;
    Json entry = {{"id", id}, {"file_name", image.file_name}, {"width", image.width}, {"height", image.height}};
    merge(entry, image.facts);
    m.images.push_back(std::move(entry));
    for (const CocoAnnotation& a : annotations) {
        if (a.mask.area == 0) continue;
        const auto category = m.category_ids.find(a.category);
        CATHLAB_CHECK(category != m.category_ids.end(), "an annotation of a category that was not named");
        Json object = {
            {"image_id", id},     {"category_id", category->second},
            {"bbox", a.mask.box}, {"area", a.mask.area},
            {"iscrowd", 0},       {"segmentation", {{"size", {image.height, image.width}}, {"counts", a.mask.counts}}}};
        merge(object, a.facts);
        m.annotation(object);
    }
    if (key_points.empty()) return;
    Json numbers = Json::array();
    int seen = 0;
    for (const CocoKeyPoint& p : key_points) {
        const bool named = p.visibility > 0;
        numbers.push_back(named ? rounded(p.x) : 0.0);
        numbers.push_back(named ? rounded(p.y) : 0.0);
        numbers.push_back(p.visibility);
        seen += named ? 1 : 0;
    }
    Json object = {{"image_id", id},
                   {"category_id", m.scene_id},
                   {"bbox", {0, 0, image.width, image.height}},
                   {"area", static_cast<std::int64_t>(image.width) * image.height},
                   {"iscrowd", 0},
                   {"segmentation", Json::array()},
                   {"num_keypoints", seen},
                   {"keypoints", numbers}};
    m.annotation(object);
}

void CocoWriter::close() {
    Impl& m = *impl_;
    m.write("\n],\n\"images\": " + m.images.dump() + ",\n\"categories\": " + m.categories.dump() +
            ",\n\"licenses\": [],\n\"info\": " + Json({{"description", m.description}, {"version", "1.0"}}).dump() +
            "}\n");
    m.file.close();
    if (!m.file) throw UserError("cannot write '" + m.path + "': the disk is full or the file cannot be written");
    std::error_code error;
    std::filesystem::rename(m.part, m.path, error);
    if (error) throw UserError("cannot write '" + m.path + "': " + error.message());
}

}  // namespace cathlab
