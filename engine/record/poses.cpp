#include "record/poses.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string_view>

#include "core/check.h"
#include "core/errors.h"
#include "core/hash.h"

namespace cathlab {
namespace {

static_assert(std::endian::native == std::endian::little, "poses.bin is little endian");

constexpr std::string_view magic{"cathposes\0\0\0\0\0\0\0", 16};
constexpr std::uint32_t version = 1;
constexpr double at_rest_mm = 1e-3;
constexpr std::uint64_t end_step = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t most_record_bytes = 1ULL << 28U;
constexpr std::size_t most_devices = 64, most_name = 256;

std::string path_in(const std::string& folder) {
    return folder + "/poses.bin";
}

template <class T>
void put(std::string& out, T value) {
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    out.append(bytes.data(), bytes.size());
}
void put_count(std::string& out, std::size_t n) {
    put(out, static_cast<std::uint32_t>(n));
}
void put_float(std::string& out, double value) {
    put(out, static_cast<float>(value));
}
void put_vec(std::string& out, const Vec3& v) {
    for (int k = 0; k < 3; ++k) put_float(out, v[k]);
}
void put_text(std::string& out, const std::string& text) {
    put_count(out, text.size());
    out += text;
}

std::uint64_t sum_of(std::uint64_t step, std::string_view bytes) {
    Hash64 hash;
    hash.word(step);
    hash.word(bytes.size());
    hash.bytes(bytes.data(), bytes.size());
    return hash.value();
}

// Where a piece differs from the one before.
bool alike(const DevicePose& d, std::size_t a, std::size_t b) {
    return d.radius_mm[a] == d.radius_mm[b] && d.material_of[a] == d.material_of[b] &&
           (d.inner_radius_mm.empty() || d.inner_radius_mm[a] == d.inner_radius_mm[b]);
}

void put_device(std::string& out, const DevicePose& d) {
    put_text(out, d.name);
    put_count(out, d.points.size());
    for (const Vec3& p : d.points) put_vec(out, p);
    std::vector<std::size_t> begin;
    for (std::size_t i = 0; i < d.radius_mm.size(); ++i)
        if (i == 0 || !alike(d, i - 1, i)) begin.push_back(i);
    put_count(out, begin.size());
    for (std::size_t r = 0; r < begin.size(); ++r) {
        const std::size_t i = begin[r], end = r + 1 < begin.size() ? begin[r + 1] : d.radius_mm.size();
        put_count(out, end - i);
        put_float(out, d.radius_mm[i]);
        put_float(out, d.inner_radius_mm.empty() ? -1.0 : d.inner_radius_mm[i]);
        put_text(out, d.materials[d.material_of[i]]);
    }
}

void put_wall(std::string& out, const std::vector<Vec3>& rest, const std::vector<Vec3>& now) {
    CATHLAB_CHECK(rest.size() == now.size(), "the lumen has as many vertices as at rest");
    const auto moved = [&](std::size_t i) { return (now[i] - rest[i]).squaredNorm() > at_rest_mm * at_rest_mm; };
    double most_mm = 0.0;
    for (std::size_t i = 0; i < now.size(); ++i) most_mm = std::max(most_mm, (now[i] - rest[i]).cwiseAbs().maxCoeff());
    const float unit = static_cast<float>(std::max(most_mm / 32000.0, 1e-4));
    put(out, unit);
    const std::size_t count_at = out.size();
    std::uint32_t runs = 0;
    put_count(out, 0);
    for (std::size_t i = 0; i < now.size(); ++i) {
        if (!moved(i)) continue;
        std::size_t end = i + 1;  // a single vertex at rest is cheaper within a run than two runs are
        while (end < now.size() && (moved(end) || (end + 1 < now.size() && moved(end + 1)))) ++end;
        put_count(out, i);
        put_count(out, end - i);
        for (; i < end; ++i)
            for (int k = 0; k < 3; ++k)
                put(out, static_cast<std::int16_t>(std::lround((now[i][k] - rest[i][k]) / static_cast<double>(unit))));
        ++runs;
    }
    std::memcpy(out.data() + count_at, &runs, sizeof runs);
}

// Reads what must be there; every fault is told by throwing a sentence.
class Bytes {
public:
    explicit Bytes(std::string_view bytes) : left_(bytes) {}

    template <class T>
    T get() {
        if (left_.size() < sizeof(T)) throw UserError("ends too soon");
        T value;
        std::memcpy(&value, left_.data(), sizeof(T));
        left_.remove_prefix(sizeof(T));
        return value;
    }
    /// Of things of at least `size` bytes each.
    std::size_t count(std::size_t size) {
        const auto n = get<std::uint32_t>();
        if (n > left_.size() / size) throw UserError("names more than it holds");
        return n;
    }
    double number() {
        const auto value = get<float>();
        if (!std::isfinite(value)) throw UserError("holds a number that is not finite");
        return value;
    }
    Vec3 vec() {
        const double x = number(), y = number(), z = number();
        return {x, y, z};
    }
    std::string text() {
        const std::size_t n = count(1);
        if (n > most_name) throw UserError("holds a name that is too long");
        std::string out(left_.substr(0, n));
        left_.remove_prefix(n);
        return out;
    }
    bool empty() const { return left_.empty(); }

private:
    std::string_view left_;
};

DevicePose get_device(Bytes& in) {
    DevicePose out;
    out.name = in.text();
    out.points.resize(in.count(12));
    for (Vec3& p : out.points) p = in.vec();
    const std::size_t pieces = std::max<std::size_t>(1, out.points.size()) - 1;
    const std::size_t runs = in.count(16);
    bool bore = false;
    for (std::size_t r = 0; r < runs; ++r) {
        const std::size_t n = in.get<std::uint32_t>();
        const double radius = in.number(), inner = in.number();
        const std::string material = in.text();
        if (n > pieces - out.radius_mm.size() || !(radius > 0.0) || inner >= radius ||
            (r > 0 && bore != (inner >= 0.0)))
            throw UserError("holds a device that cannot be");
        bore = inner >= 0.0;
        if (out.materials.size() > 200) throw UserError("holds a device that cannot be");
        out.radius_mm.insert(out.radius_mm.end(), n, radius);
        if (bore) out.inner_radius_mm.insert(out.inner_radius_mm.end(), n, inner);
        out.material_of.insert(out.material_of.end(), n, out.material_index(material));
    }
    if (out.points.size() < 2 || out.radius_mm.size() != pieces) throw UserError("holds a device that cannot be");
    return out;
}

void get_wall(Bytes& in, const std::vector<Vec3>& rest, std::vector<Vec3>& now) {
    now = rest;
    const double unit = in.number();
    if (!(unit > 0.0)) throw UserError("has a unit that cannot be");
    std::size_t after = 0;
    for (std::size_t runs = in.count(8); runs > 0; --runs) {
        const std::size_t first = in.get<std::uint32_t>(), n = in.count(6);
        if (first < after || first > now.size() || n > now.size() - first)
            throw UserError("moves a vertex that the lumen does not have");
        for (std::size_t i = first; i < first + n; ++i)
            for (int k = 0; k < 3; ++k) now[i][k] += unit * in.get<std::int16_t>();
        after = first + n;
    }
}

}  // namespace

std::uint8_t DevicePose::material_index(const std::string& material) {
    const auto it = std::find(materials.begin(), materials.end(), material);
    const auto index = static_cast<std::uint8_t>(it - materials.begin());
    if (it == materials.end()) materials.push_back(material);
    return index;
}

PosesWriter::PosesWriter(const std::string& folder, const PosesFrame& frame, double rate_hz)
    : frame_(frame), rate_hz_(rate_hz), file_(path_in(folder)) {
    CATHLAB_CHECK(rate_hz > 0.0 && frame.rest != nullptr, "poses have a rate and a rest");
    std::string head(magic);
    put(head, version);
    put_count(head, frame.rest->size());
    put_count(head, frame.nodes);
    put_count(head, 0);
    put(head, frame.anatomy_hash);
    put(head, rate_hz);
    put(head, sum_of(0, head));
    file_.append(head);
}

void PosesWriter::add(std::int64_t step, const ScenePoses& poses) {
    std::string& out = record_;
    out.clear();
    put(out, static_cast<std::uint8_t>(poses.tip ? 1 : 0));
    const ScenePoses::Tip tip = poses.tip.value_or(ScenePoses::Tip());
    put_vec(out, tip.position);
    put_vec(out, tip.forward);
    put_count(out, poses.devices.size());
    for (const DevicePose& device : poses.devices) put_device(out, device);
    put_wall(out, *frame_.rest, poses.lumen);
    put_count(out, poses.wall_force_n.size());
    for (const auto& [vertex, newtons] : poses.wall_force_n) {
        put_count(out, static_cast<std::size_t>(vertex));
        put_float(out, newtons);
    }
    put_count(out, poses.contrast_mg_ml.size());
    for (const double c : poses.contrast_mg_ml) put_float(out, c);
    std::string head;
    put(head, static_cast<std::uint64_t>(step));
    put(head, static_cast<std::uint64_t>(out.size()));
    put(head, sum_of(static_cast<std::uint64_t>(step), out));
    file_.append(head);
    file_.append(out);
    ++count_;
}

void PosesWriter::close() {
    std::string count, end;
    put(count, count_);
    put(end, end_step);
    put(end, static_cast<std::uint64_t>(count.size()));
    put(end, sum_of(end_step, count));
    file_.append(end + count);
    file_.close();
}

bool has_poses(const std::string& folder) {
    return std::filesystem::exists(path_in(folder));
}

PosesReader::PosesReader(const std::string& folder, const PosesFrame& frame, bool complete)
    : path_(path_in(folder)), frame_(frame), complete_(complete), file_(std::fopen(path_.c_str(), "rb")) {
    CATHLAB_CHECK(frame.rest != nullptr, "poses have a rest");
    if (!file_) fail(std::string("cannot be read: ") + std::strerror(errno));
    std::string head(magic.size() + 32, '\0');
    std::uint64_t sum = 0;
    if (std::fread(head.data(), 1, head.size(), file_.get()) != head.size() ||
        std::fread(&sum, sizeof sum, 1, file_.get()) != 1 || !std::string_view(head).starts_with(magic))
        fail("is no file of poses");
    Bytes in(std::string_view(head).substr(magic.size()));
    const auto its_version = in.get<std::uint32_t>();
    if (its_version != version)
        fail("is of version " + std::to_string(its_version) + ", this program reads " + std::to_string(version));
    const auto vertices = in.get<std::uint32_t>(), nodes = in.get<std::uint32_t>();
    in.get<std::uint32_t>();
    const auto anatomy = in.get<std::uint64_t>();
    rate_hz_ = in.get<double>();
    if (sum != sum_of(0, head)) fail("its head was changed or damaged");
    if (vertices != frame.rest->size() || nodes != frame.nodes || anatomy != frame.anatomy_hash)
        fail("belongs to another anatomy");
    if (!(rate_hz_ > 0.0) || !std::isfinite(rate_hz_)) fail("has a rate that cannot be");
    ended_ = !read_head();
}

void PosesReader::fail(const std::string& what) const {
    throw UserError(path_ + ": " + what);
}

bool PosesReader::read_head() {
    const std::string name = "record " + std::to_string(records_ + 1);
    const auto cut = [&] {
        if (complete_) fail("ends before its end, in or after " + std::to_string(records_) + " records (truncated?)");
        return false;
    };
    std::array<std::uint64_t, 3> head{};
    if (std::fread(head.data(), 1, sizeof head, file_.get()) != sizeof head) return cut();
    const auto [step, size, sum] = head;
    if (size > most_record_bytes) fail(name + " is larger than a record can be (damaged?)");
    bytes_.resize(size);
    if (std::fread(bytes_.data(), 1, size, file_.get()) != size) return cut();
    if (sum != sum_of(step, bytes_)) fail(name + " was changed or damaged: its sum does not fit");
    if (step == end_step) {
        std::uint64_t count = 0;
        if (size == sizeof count) std::memcpy(&count, bytes_.data(), sizeof count);
        if (count != records_)
            fail("has " + std::to_string(records_) + " records, its end names " + std::to_string(count));
        if (std::fgetc(file_.get()) != EOF) fail("goes on after its end");
        return false;
    }
    if (step > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()) ||
        static_cast<std::int64_t>(step) <= next_step_)
        fail(name + " is out of order");
    next_step_ = static_cast<std::int64_t>(step);
    ++records_;
    return true;
}

void PosesReader::read_poses() {
    try {
        Bytes in(last_);
        const bool tip = in.get<std::uint8_t>() != 0;
        const Vec3 position = in.vec(), forward = in.vec();
        poses_.tip.reset();
        if (tip) {
            const double length = std::sqrt(forward.squaredNorm());
            if (std::fabs(length - 1.0) > 1e-3) throw UserError("holds a direction that is none");
            poses_.tip = ScenePoses::Tip{position, forward / length};
        }
        poses_.devices.clear();
        const std::size_t devices = in.count(12);
        if (devices > most_devices) throw UserError("names more devices than there can be");
        for (std::size_t i = 0; i < devices; ++i) poses_.devices.push_back(get_device(in));
        get_wall(in, *frame_.rest, poses_.lumen);
        poses_.wall_force_n.clear();
        for (std::size_t n = in.count(8); n > 0; --n) {
            const auto vertex = in.get<std::uint32_t>();
            const double newtons = in.number();
            if (vertex >= frame_.rest->size()) throw UserError("presses a vertex that the lumen does not have");
            poses_.wall_force_n.emplace_back(static_cast<Index>(vertex), newtons);
        }
        poses_.contrast_mg_ml.resize(in.count(4));
        if (!poses_.contrast_mg_ml.empty() && poses_.contrast_mg_ml.size() != frame_.nodes)
            throw UserError("has contrast medium at nodes that the vessels do not have");
        for (double& c : poses_.contrast_mg_ml) c = in.number();
        if (!in.empty()) throw UserError("goes on after its end");
    } catch (const UserError& error) {
        fail("record " + std::to_string(last_record_) + " " + error.what());
    }
}

const ScenePoses& PosesReader::at(std::int64_t step) {
    bool newer = false;
    while (!ended_ && next_step_ <= step) {
        std::swap(last_, bytes_);
        last_record_ = records_;
        newer = any_ = true;
        ended_ = !read_head();
    }
    if (!any_) fail("has no poses of step " + std::to_string(step));
    if (newer) read_poses();
    return poses_;
}

}  // namespace cathlab
