#include "render/device_chords.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/check.h"

namespace cathlab {

namespace {

struct Span {
    double from = 0, to = -1;

    double length() const { return to > from ? to - from : 0.0; }
    // Keeps where slope * t + height <= 0.
    void cut(double slope, double height) {
        if (std::fabs(slope) < 1e-12) {
            if (height > 0) *this = {};
        } else if (slope > 0) {
            to = std::min(to, -height / slope);
        } else {
            from = std::max(from, -height / slope);
        }
    }
};

// A ray's products with what a piece is made of.
struct RayProducts {
    double axis, offset, plane_a, plane_b;  // direction . axis, . offset, . plane_a, . plane_b
    double squared;                         // |direction|^2
};

// What the length of a ray within a piece needs of the piece, once for all rays from the same origin.  Directions have
// any length; lengths come out in units of it.
struct Prepared {
    Vec3 axis, offset;  // offset = origin - a
    Vec3 plane_a, plane_b;
    double along, outer, inner;  // offset . axis; squared distance of the origin from the axis - radius^2, - bore^2
    double height_a, height_b;   // of the origin over the end planes
    bool hollow;

    Prepared(const ChordPiece& piece, const Vec3& origin)
        : axis((piece.b - piece.a).normalized()),
          offset(origin - piece.a),
          plane_a(piece.plane_a),
          plane_b(piece.plane_b),
          along(offset.dot(axis)),
          height_a(offset.dot(piece.plane_a)),
          height_b((origin - piece.b).dot(piece.plane_b)),
          hollow(piece.bore > 0.0) {
        const double across = (offset - along * axis).squaredNorm();
        outer = across - piece.radius * piece.radius;
        inner = across - piece.bore * piece.bore;
    }
    RayProducts products(const Vec3& direction) const {
        return {direction.dot(axis), direction.dot(offset), direction.dot(plane_a), direction.dot(plane_b),
                direction.squaredNorm()};
    }
    double length(const RayProducts& r) const {
        const double across = r.squared - r.axis * r.axis;  // squared length of the direction's part across the axis
        const double half_b = r.offset - along * r.axis;
        if (half_b * half_b < across * outer) return 0.0;  // passes by
        const double whole = between(r, across, half_b, outer);
        return hollow && whole > 0.0 ? whole - between(r, across, half_b, inner) : whole;
    }

private:
    // Within the cylinder of c = squared distance of the origin from the axis - radius^2, between the end planes.
    double between(const RayProducts& r, double across, double half_b, double c) const {
        Span span;
        if (across < 1e-14 * r.squared) {
            constexpr double far = 1e9;
            if (c <= 0) span = {-far, far};
        } else {
            const double disc = half_b * half_b - across * c;
            if (disc <= 0) return 0.0;
            const double root = std::sqrt(disc), per = 1.0 / across;
            span = {(-half_b - root) * per, (-half_b + root) * per};
        }
        span.cut(r.plane_a, height_a);
        span.cut(r.plane_b, height_b);
        return span.length();
    }
};

double half_ball(const Vec3& origin, const Vec3& direction, const Vec3& center, const Vec3& outward, double r) {
    const Vec3 rel = origin - center;
    const double middle = -rel.dot(direction);
    const double disc = r * r - (rel + middle * direction).squaredNorm();
    if (disc <= 0) return 0;
    const double half = std::sqrt(disc);
    Span span{middle - half, middle + half};
    span.cut(-direction.dot(outward), -rel.dot(outward));
    return span.length();
}

// direction: a unit vector.
double balls(const ChordPiece& p, const Vec3& origin, const Vec3& direction) {
    double sum = 0;
    if (p.ball_a) sum += half_ball(origin, direction, p.a, p.plane_a, p.radius);
    if (p.ball_b) sum += half_ball(origin, direction, p.b, p.plane_b, p.radius);
    return sum;
}

struct Box {
    int x0 = 0, x1 = 0, y0 = 0, y1 = 0;  // pixels, half open
    // The axis on the picture: pixels farther than reach from it cannot be met.
    Vec2 start = Vec2::Zero(), axis = Vec2::Zero(), normal = Vec2::Zero();
    double reach = 0, from = -1e9, to = 1e9;  // along the axis: between from and to

    bool holds(double x, double y) const {
        const double s = (Vec2(x, y) - start).dot(axis);
        return s >= from && s <= to;
    }
};

Box pixel_box(const ChordPiece& p, const Projection& projection) {
    double x0 = std::numeric_limits<double>::infinity(), y0 = x0, x1 = -x0, y1 = -x0, reach_px_max = 0;
    for (const auto& [end, plane] : {std::pair(p.a, p.plane_a), std::pair(p.b, p.plane_b)}) {
        // The mitre reaches r / cos(half the bend) from the axis.
        const Vec3 axis = (p.b - p.a).normalized();
        const double lean = std::max(0.2, std::fabs(plane.dot(axis)));
        const double reach = p.radius / lean;
        const double depth = projection.depth(end) - reach;
        if (depth < 1.0) return {};
        const double reach_px = 1.05 * reach * projection.source_detector_mm() / depth / projection.pixel_mm() + 1.0;
        reach_px_max = std::max(reach_px_max, reach_px);
        const Vec2 at = projection.pixel(end);
        x0 = std::min(x0, at.x() - reach_px);
        x1 = std::max(x1, at.x() + reach_px);
        y0 = std::min(y0, at.y() - reach_px);
        y1 = std::max(y1, at.y() + reach_px);
    }
    const auto inside = [](double v, int limit) {
        return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(limit)));
    };
    Box box{inside(std::floor(x0), projection.width()), inside(std::ceil(x1), projection.width()),
            inside(std::floor(y0), projection.height()), inside(std::ceil(y1), projection.height())};
    box.start = projection.pixel(p.a);
    const Vec2 run = projection.pixel(p.b) - box.start;
    if (run.norm() > 1.0) {
        box.axis = run.normalized();
        box.normal = Vec2(-box.axis.y(), box.axis.x());
        // How far an end sticks out: its slanted plane, its ball, or the disc seen from the side.
        const Vec3 axis = (p.b - p.a).normalized();
        const double tilt = std::fabs(axis.dot((p.a - projection.source()).normalized()));
        const double scale = reach_px_max / p.radius;
        const auto margin = [&](const Vec3& plane, bool ball) {
            const double lean = std::fabs(plane.dot(axis));
            const double slant = std::sqrt(std::max(0.0, 1 - lean * lean)) / std::max(0.2, lean);
            return 1.5 + (ball ? 1.0 : std::min(1.0, tilt + slant)) * p.radius * scale;
        };
        box.from = -margin(p.plane_a, p.ball_a);
        box.to = run.norm() + margin(p.plane_b, p.ball_b);
    }
    box.reach = reach_px_max;
    return box;
}

// Columns of the row at height y whose pixels' centres lie within reach of the axis.
std::pair<int, int> columns_of(const Box& box, double y) {
    if (std::fabs(box.normal.x()) < 1e-6) return {box.x0, box.x1};
    const double middle = box.start.x() - (y - box.start.y()) * box.normal.y() / box.normal.x();
    const double half = box.reach / std::fabs(box.normal.x());
    const double first = std::max<double>(box.x0, std::ceil(middle - half - 0.5));
    const double last = std::min<double>(box.x1, std::floor(middle + half - 0.5) + 1.0);
    return first < last ? std::pair(static_cast<int>(first), static_cast<int>(last)) : std::pair(0, 0);
}

// The detector's point of a picture's place, from the source: origin + x right + y down, x and y in pixels.
struct PixelRays {
    Vec3 origin, right, down;
    explicit PixelRays(const Projection& projection)
        : origin(projection.to_detector(0, 0)),
          right(projection.to_detector(1, 0) - origin),
          down(projection.to_detector(0, 1) - origin) {}
};

// Lengths within the piece on side x side rays through the pixel, added up.
double sum_of_samples(const ChordPiece& piece, const Prepared& prepared, const PixelRays& rays, int x, int y,
                      int side) {
    const double spacing = 1.0 / side;
    const Vec3 across = spacing * rays.right, along = spacing * rays.down;
    Vec3 row = rays.origin + (x + 0.5 * spacing) * rays.right + (y + 0.5 * spacing) * rays.down;
    const bool with_balls = piece.ball_a || piece.ball_b;
    double sum = 0;
    for (int line = 0; line < side; ++line, row += along) {
        Vec3 d = row;
        for (int column = 0; column < side; ++column, d += across) {
            const RayProducts products = prepared.products(d);
            const double length = prepared.length(products);
            if (length > 0) sum += length * std::sqrt(products.squared);
            if (with_balls) sum += balls(piece, piece.a + prepared.offset, d / std::sqrt(products.squared));
        }
    }
    return sum;
}

}  // namespace

void append_pieces(const FrameDevice& device, const std::vector<std::uint8_t>& medium_of,
                   std::vector<ChordPiece>& out) {
    const std::size_t n = device.radius_mm.size();
    CATHLAB_CHECK(device.points.size() == n + 1 || n == 0, "a device of n pieces has n + 1 points");
    CATHLAB_CHECK(device.inner_radius_mm.empty() || device.inner_radius_mm.size() == n, "one bore a piece");
    CATHLAB_CHECK(device.material_of.size() == n, "one material a piece");
    const std::size_t first = out.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 along = device.points[i + 1] - device.points[i];
        if (!(along.norm() > 1e-6)) continue;
        ChordPiece piece;
        piece.a = device.points[i];
        piece.b = device.points[i + 1];
        piece.plane_b = along.normalized();
        piece.plane_a = -piece.plane_b;
        piece.radius = device.radius_mm[i];
        piece.bore = device.inner_radius_mm.empty() ? 0.0 : device.inner_radius_mm[i];
        CATHLAB_CHECK(device.material_of[i] < medium_of.size(), "material index out of range");
        piece.medium = medium_of[device.material_of[i]];
        out.push_back(piece);
    }
    if (out.size() == first) return;
    for (std::size_t i = first; i + 1 < out.size(); ++i) {
        const Vec3 bisector = (out[i].plane_b - out[i + 1].plane_a).normalized();
        if (bisector.allFinite() && bisector.dot(out[i].plane_b) > 0.2) {  // a sharper kink keeps its flat ends
            out[i].plane_b = bisector;
            out[i + 1].plane_a = -bisector;
        }
    }
    out[first].ball_a = out[first].bore <= 0.0;
    out.back().ball_b = out.back().bore <= 0.0;
}

double chord(const ChordPiece& piece, const Vec3& origin, const Vec3& direction) {
    const Prepared prepared(piece, origin);
    return prepared.length(prepared.products(direction)) + balls(piece, origin, direction);
}

void draw_devices(const std::vector<ChordPiece>& pieces, int media, const Projection& projection, int samples,
                  const Workers& workers, DeviceLengths& out) {
    CATHLAB_CHECK(samples >= 1 && media >= 0, "samples and media must be positive");
    const int height = projection.height();
    const std::size_t width = static_cast<std::size_t>(projection.width());
    std::vector<Box> boxes;
    std::vector<Prepared> prepared;
    std::vector<std::vector<std::uint32_t>> pieces_of_row(static_cast<std::size_t>(height));
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        boxes.push_back(pixel_box(pieces[i], projection));
        prepared.emplace_back(pieces[i], projection.source());
        if (boxes[i].x0 >= boxes[i].x1) continue;
        for (int y = boxes[i].y0; y < boxes[i].y1; ++y) {
            pieces_of_row[static_cast<std::size_t>(y)].push_back(static_cast<std::uint32_t>(i));
        }
    }

    struct Row {
        std::vector<std::uint32_t> x;
        std::vector<float> length;
    };
    std::vector<Row> rows(static_cast<std::size_t>(height));
    const auto per_pixel = static_cast<std::size_t>(media);
    const PixelRays rays(projection);
    workers.for_ranges(rows.size(), 8, [&](std::size_t begin, std::size_t end) {
        std::vector<double> sums(width * per_pixel);
        std::vector<std::uint8_t> touched(width);
        for (std::size_t y = begin; y < end; ++y) {
            if (pieces_of_row[y].empty()) continue;
            std::fill(sums.begin(), sums.end(), 0.0);
            std::fill(touched.begin(), touched.end(), std::uint8_t{0});
            for (const std::uint32_t i : pieces_of_row[y]) {
                const ChordPiece& piece = pieces[i];
                const auto [first, last] = columns_of(boxes[i], static_cast<double>(y) + 0.5);
                // A thick piece changes little within a pixel.
                const int side = boxes[i].reach > 4.0 ? std::min(2, samples) : samples;
                for (int x = first; x < last; ++x) {
                    if (!boxes[i].holds(x + 0.5, static_cast<double>(y) + 0.5)) continue;
                    const double sum = sum_of_samples(piece, prepared[i], rays, x, static_cast<int>(y), side);
                    if (sum <= 0) continue;
                    const auto column = static_cast<std::size_t>(x);
                    sums[column * per_pixel + piece.medium] += sum / (side * side);
                    touched[column] = 1;
                }
            }
            for (std::size_t x = 0; x < width; ++x) {
                if (touched[x] == 0) continue;
                rows[y].x.push_back(static_cast<std::uint32_t>(x));
                for (std::size_t m = 0; m < per_pixel; ++m) {
                    rows[y].length.push_back(static_cast<float>(sums[x * per_pixel + m]));
                }
            }
        }
    });

    out.media = media;
    out.pixel.clear();
    out.length_mm.clear();
    for (std::size_t y = 0; y < rows.size(); ++y) {
        for (const std::uint32_t x : rows[y].x) out.pixel.push_back(static_cast<std::uint32_t>(y * width) + x);
        out.length_mm.insert(out.length_mm.end(), rows[y].length.begin(), rows[y].length.end());
    }
}

}  // namespace cathlab
