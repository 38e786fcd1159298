#include "anatomy/torso.h"

#include <algorithm>
#include <cmath>

#include "anatomy/remesh.h"
#include "anatomy/voxel_surface.h"
#include "core/deterministic_math.h"

namespace cathlab {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double clear = 6.0;  // mm between neighbours: room for what decimation moves

double ellipsoid(const Vec3& p, const Vec3& center, const Vec3& half) {
    const Vec3 q = (p - center).cwiseQuotient(half);
    const double k = q.norm();
    const double g = q.cwiseQuotient(half).norm();
    return g > 1e-9 ? k * (k - 1.0) / g : -half.minCoeff();
}

double capsule(const Vec3& p, const Vec3& a, const Vec3& b, double r) {
    const Vec3 ab = b - a;
    const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    return (p - a - t * ab).norm() - r;
}

double blend(double a, double b, double k) {
    const double h = std::max(k - std::fabs(a - b), 0.0) / k;
    return std::min(a, b) - 0.25 * h * h * k;
}

double cut(double a, double b, double k) {
    return -blend(-a, -b, k);
}

/// y of the middle of the vertebral bodies at height z: kyphosis of the chest, lordosis of the loins, some 15 mm behind
/// the aorta's back wall.
double spine_y(double z) {
    return 80.0 - 18.0 * det::exp(-((z + 205.0) / 75.0) * ((z + 205.0) / 75.0));
}

ContextSolid solid(const std::string& name, const std::string& material, const std::string& inside,
                   const ScalarField& field, const Vec3& low, const Vec3& high, double voxel, std::size_t triangles,
                   const Workers& workers) {
    TriMesh mesh = mesh_level_set(field, low, high, voxel, workers);
    taubin_smooth(mesh, 4, 0.5, -0.53);
    return {name, material, inside, decimate(mesh, triangles, 0.3)};
}

/// Body width and depth at heights, after general anatomy [gray2015]: a rounded box section, half axes in mm.
struct Section {
    double z, half_width, front, back;
};
constexpr Section outline[] = {
    {-590.0, 172.0, -52.0, 128.0}, {-470.0, 178.0, -62.0, 142.0}, {-380.0, 172.0, -72.0, 140.0},
    {-270.0, 150.0, -82.0, 132.0}, {-150.0, 160.0, -88.0, 138.0}, {-20.0, 172.0, -86.0, 146.0},
    {80.0, 178.0, -66.0, 146.0},   {140.0, 172.0, -48.0, 138.0},  {180.0, 120.0, -42.0, 126.0},
    {212.0, 66.0, -44.0, 112.0},   {290.0, 62.0, -46.0, 108.0}};

double body(const Vec3& p) {
    const Section* a = &outline[0];
    const Section* b = &outline[1];
    for (std::size_t i = 1; i + 1 < std::size(outline) && outline[i].z < p.z(); ++i) {
        a = &outline[i];
        b = &outline[i + 1];
    }
    double t = std::clamp((p.z() - a->z) / (b->z - a->z), 0.0, 1.0);
    t = t * t * (3.0 - 2.0 * t);
    const double width = a->half_width + t * (b->half_width - a->half_width);
    const double front = a->front + t * (b->front - a->front);
    const double back = a->back + t * (b->back - a->back);
    const double depth = 0.5 * (back - front);
    const double x = std::fabs(p.x()) / width;
    const double y = std::fabs(p.y() - 0.5 * (front + back)) / depth;
    // |x|^3 + |y|^3 = 1: between an ellipse and a box
    const double k = det::pow(std::max(x * x * x + y * y * y, 1e-9), 1.0 / 3.0);
    const double side = (k - 1.0) * std::min(width, depth);
    return cut(side, std::max(-590.0 - p.z(), p.z() - 290.0), 25.0);
}

/// Left of the midline, in front and below of the root; the left ventricle's tip points to the left, forward and down.
double heart(const Vec3& p, double grow) {
    const double ventricles = capsule(p, Vec3(10.0, -12.0, -32.0), Vec3(42.0, -34.0, -58.0), 33.0);
    const double atria = ellipsoid(p, Vec3(-6.0, 18.0, -18.0), Vec3(44.0, 27.0, 36.0));
    return blend(ventricles, atria, 20.0) - grow;
}

/// Between the lungs: spine, great vessels, gullet.
double mediastinum(const Vec3& p) {
    const double x = std::fabs(p.x() - 4.0);
    const double above = std::clamp((p.z() - 60.0) / 60.0, 0.0, 1.0);
    return x - (38.0 - 8.0 * above);
}

double dome(const Vec3& p, double side) {  // height above the diaphragm's dome (positive = chest)
    const Vec3 q = p - Vec3(side * 82.0, 22.0, 0.0);
    const double top = side < 0.0 ? -62.0 : -76.0;  // the right dome stands higher over the liver
    const double spread = (q.x() * q.x()) / (105.0 * 105.0) + (q.y() * q.y()) / (120.0 * 120.0);
    return 0.8 * (p.z() - (top - 70.0 * spread));
}

double lung(const Vec3& p, double side) {
    const double chest = ellipsoid(p, Vec3(side * 56.0, 34.0, -20.0), Vec3(84.0, 92.0, 178.0));
    double d = cut(chest, -heart(p, clear), 8.0);
    d = cut(d, -mediastinum(p), 10.0);
    d = cut(d, -dome(p, side), 10.0);
    d = cut(d, -(side * p.x() - 30.0), 5.0);
    return d;
}

/// The closed tube round a curve with an oval section.
TriMesh tube(const std::vector<Vec3>& path, double half_height, double half_width, int round) {
    TriMesh mesh;
    const auto n = static_cast<Index>(path.size());
    for (Index i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Vec3 along = (path[std::min(k + 1, path.size() - 1)] - path[k == 0 ? 0 : k - 1]).normalized();
        const Vec3 across = along.cross(Vec3::UnitZ()).normalized();
        const Vec3 up = across.cross(along);
        const double taper = i == 0 || i == n - 1 ? 0.6 : 1.0;
        for (int r = 0; r < round; ++r) {
            const double angle = 2.0 * pi * r / round;
            mesh.vertices.push_back(
                path[k] + taper * (half_width * det::cos(angle) * across + half_height * det::sin(angle) * up));
        }
    }
    auto at = [&](Index i, int r) { return i * round + r % round; };
    for (Index i = 0; i + 1 < n; ++i) {
        for (int r = 0; r < round; ++r) {
            mesh.triangles.emplace_back(at(i, r), at(i, r + 1), at(i + 1, r + 1));
            mesh.triangles.emplace_back(at(i, r), at(i + 1, r + 1), at(i + 1, r));
        }
    }
    for (int r = 1; r + 1 < round; ++r) {
        mesh.triangles.emplace_back(at(0, 0), at(0, r + 1), at(0, r));
        mesh.triangles.emplace_back(at(n - 1, 0), at(n - 1, r), at(n - 1, r + 1));
    }
    if (signed_volume(mesh) < 0.0) {
        for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    }
    return mesh;
}

struct Vertebra {
    std::string name;
    double z, height, half_width, half_depth;
};

/// T1 to L5: heights of bodies 16 to 28 mm, width 28 to 50 mm, depth 16 to 34 mm, discs between [panjabi1991]
/// [panjabi1992].
std::vector<Vertebra> vertebrae() {
    std::vector<Vertebra> out;
    double z = 160.0;
    for (int i = 0; i < 17; ++i) {
        const double t = i / 16.0;
        Vertebra v;
        v.name = i < 12 ? "T" + std::to_string(i + 1) : "L" + std::to_string(i - 11);
        v.height = 16.5 + 12.0 * t;
        v.half_width = 14.0 + 10.0 * t;
        v.half_depth = 9.0 + 7.0 * t;
        v.z = z - 0.5 * v.height;
        z -= v.height + 3.5 + 6.0 * t;
        out.push_back(v);
    }
    return out;
}

double vertebra(const Vec3& p, const Vertebra& v) {
    const Vec3 q = p - Vec3(0.0, spine_y(v.z), v.z);
    const double x = q.x() / v.half_width;
    const double y = q.y() / v.half_depth;
    const double side = (std::sqrt(x * x + y * y) - 1.0) * v.half_depth;
    const double bone = cut(side, std::fabs(q.z()) - 0.5 * v.height, 4.0);
    const double back = v.half_depth + 14.0;
    const double spinous = capsule(q, Vec3(0.0, back, 0.0), Vec3(0.0, back + 16.0, -4.0), 4.5);
    const double left = capsule(q, Vec3(10.0, v.half_depth - 3.0, 2.0), Vec3(v.half_width + 9.0, back, 2.0), 4.5);
    const double right = capsule(q, Vec3(-10.0, v.half_depth - 3.0, 2.0), Vec3(-v.half_width - 9.0, back, 2.0), 4.5);
    const double arch = std::min(capsule(q, Vec3(10.0, v.half_depth, 2.0), Vec3(0.0, back, 0.0), 4.5),
                                 capsule(q, Vec3(-10.0, v.half_depth, 2.0), Vec3(0.0, back, 0.0), 4.5));
    return blend(blend(bone, std::min(left, right), 3.0), std::min(arch, spinous), 3.0);
}

}  // namespace

std::vector<ContextSolid> make_torso(const Workers& workers) {
    std::vector<ContextSolid> out;
    out.push_back(solid("body", "soft_tissue", "", body, Vec3(-200.0, -110.0, -610.0), Vec3(200.0, 170.0, 310.0), 9.0,
                        900, workers));
    out.push_back(solid(
        "heart", "blood", "body", [](const Vec3& p) { return heart(p, 0.0); }, Vec3(-80.0, -100.0, -130.0),
        Vec3(120.0, 80.0, 60.0), 5.0, 300, workers));
    for (const double side : {-1.0, 1.0})
        out.push_back(solid(
            side < 0.0 ? "lung_right" : "lung_left", "lung", "body", [side](const Vec3& p) { return lung(p, side); },
            Vec3(-180.0, -90.0, -230.0), Vec3(180.0, 160.0, 180.0), 5.0, 600, workers));
    const std::vector<Vertebra> spine = vertebrae();
    for (const Vertebra& v : spine) {
        const double y = spine_y(v.z);
        out.push_back(solid(
            "vertebra_" + v.name, "cortical_bone", "body", [&v](const Vec3& p) { return vertebra(p, v); },
            Vec3(-50.0, y - 40.0, v.z - 40.0), Vec3(50.0, y + 65.0, v.z + 40.0), 2.0, 150, workers));
    }
    // Ribs 1 to 10 leave beside their vertebra, run round the lungs and fall to the front.
    for (int rib = 1; rib <= 10; ++rib) {
        const Vertebra& v = spine[static_cast<std::size_t>(rib - 1)];
        for (const double side : {-1.0, 1.0}) {
            std::vector<Vec3> path;
            const double t = (rib - 1) / 9.0;
            const double end = rib <= 7 ? 2.5 : 2.5 - 0.3 * (rib - 7);  // the lower ones stop at the side
            const double level = (v.z - 25.0 + 20.0) / 178.0;
            const double share = std::sqrt(std::max(0.1, 1.0 - level * level));  // of the chest's greatest section
            const double depth = 97.0 * (0.5 + 0.5 * share);
            for (int k = 0; k <= 11; ++k) {
                const double angle = 0.28 + (end - 0.28) * k / 11.0;  // 0 = back, pi = front
                const Vec3 axis(0.0, 129.0 - depth, v.z - (20.0 + 45.0 * t) * (1.0 - det::cos(angle)) * 0.7);
                const double x = std::max((52.0 + 90.0 * share) * det::sin(angle), v.half_width + 18.0);
                Vec3 p = axis + Vec3(side * x, depth * det::cos(angle), 0.0);
                while (lung(p, side) < 9.0 && body(p) < -12.0) p += 0.02 * (p - axis);  // ribs lie on the lungs
                path.push_back(p);
            }
            out.push_back({"rib_" + std::string(side < 0.0 ? "right_" : "left_") + std::to_string(rib), "cortical_bone",
                           "body", tube(path, 5.0, 3.0, 6)});
        }
    }
    return out;
}

}  // namespace cathlab
