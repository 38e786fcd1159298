#include "beam/thickness.h"

#include <algorithm>
#include <cmath>

#include "beam/materials.h"

namespace cathlab {

BodyThickness::BodyThickness(std::span<const BodySolid> solids, double energy_kev) {
    const auto attenuation = [&](const std::string& name) {
        return attenuation_per_mm(material(name), energy_kev, TableReading::straight);
    };
    const double water = attenuation("water");
    parts_.reserve(solids.size());
    for (const BodySolid& solid : solids) {
        const double inside = attenuation(solid.material);
        const double outside = solid.surrounded_by.empty() ? 0.0 : attenuation(solid.surrounded_by);
        Vec3 low = Vec3::Zero(), high = Vec3::Zero();
        if (!solid.mesh->vertices.empty()) low = high = solid.mesh->vertices.front();
        for (const Vec3& v : solid.mesh->vertices) {
            low = low.cwiseMin(v);
            high = high.cwiseMax(v);
        }
        parts_.push_back(
            {solid.mesh, (inside - outside) / water, 0.5 * (low + high), 0.5 * std::sqrt((high - low).squaredNorm())});
    }
}

double BodyThickness::water_mm(const CArmSpec& spec, const CArmPose& pose) const {
    const double step = 0.2 * spec.field_mm;
    double sum = 0.0;
    for (const Vec2& offset : {Vec2(0, 0), Vec2(step, 0), Vec2(-step, 0), Vec2(0, step), Vec2(0, -step)}) {
        const Vec3 target = pose.detector + offset.x() * pose.right + offset.y() * pose.down;
        const Vec3 direction = (target - pose.source).normalized();
        for (const Part& part : parts_) {
            const Vec3 to_center = part.center - pose.source;
            const double along = to_center.dot(direction);
            if (to_center.squaredNorm() - along * along > part.radius * part.radius) continue;
            sum += part.water_per_mm * path_length(*part.mesh, pose.source, direction);
        }
    }
    return std::max(0.0, sum / 5.0);
}

double path_length(const TriMesh& mesh, const Vec3& origin, const Vec3& direction) {
    const Vec3 z = direction.normalized();
    const Vec3 x = (std::fabs(z.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY()).cross(z).normalized();
    const Vec3 y = z.cross(x);
    std::vector<Vec3> seen;  // along the line: (across, across, depth)
    seen.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) seen.emplace_back(x.dot(v - origin), y.dot(v - origin), z.dot(v - origin));

    // Twice the signed area of (line, a, b); never 0, and exactly opposite for the edge's other triangle.
    const auto edge = [&](Index a, Index b) {
        const Vec3& p = seen[static_cast<std::size_t>(std::min(a, b))];
        const Vec3& q = seen[static_cast<std::size_t>(std::max(a, b))];
        double area = p.x() * q.y() - p.y() * q.x();
        if (area == 0.0) area = 1e-300;
        return a < b ? area : -area;
    };
    double length = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const double c = edge(t[0], t[1]);
        const double a = edge(t[1], t[2]);
        if ((c > 0.0) != (a > 0.0)) continue;
        const double b = edge(t[2], t[0]);
        if ((a > 0.0) != (b > 0.0)) continue;
        const double depth =
            (a * seen[static_cast<std::size_t>(t[0])].z() + b * seen[static_cast<std::size_t>(t[1])].z() +
             c * seen[static_cast<std::size_t>(t[2])].z()) /
            (a + b + c);
        // Counter-clockwise as seen along the line = its outer side looks onward: the line leaves.
        length += a > 0.0 ? depth : -depth;
    }
    return length;
}

}  // namespace cathlab
