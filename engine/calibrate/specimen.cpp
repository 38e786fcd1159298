#include "calibrate/specimen.h"

#include <algorithm>
#include <cmath>

#include "calibrate/stations.h"
#include "core/errors.h"

namespace cathlab {
namespace {

constexpr double held_mm = 2.5;      // of either end of a tube
constexpr double same_place = 1e-9;  // mm: rows of a lattice

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}

Gauge tube_gauge(const WallSample& sample, const WallRig& rig) {
    const TubeShape& shape = rig.shape;
    RoundGauge round;
    round.axis = shape.axis;
    for (std::size_t i = 0; i < sample.position.size(); ++i) {
        const double along = (sample.position[i] - shape.start).dot(shape.axis);
        round.centre.emplace_back(shape.start + along * shape.axis);
        round.loaded.push_back(static_cast<Index>(i));
        // The middle third of a tube; all of a ring.
        if (rig.kind == RigKind::ring || std::fabs(along / shape.length_mm - 0.5) <= 1.0 / 6.0)
            round.read.push_back(static_cast<Index>(i));
    }
    return round_gauge(sample, round, rig.stress, std::string(rig_name(rig.kind)));
}

Specimen tube_specimen(const WallRig& rig, const SceneWall& wall) {
    Specimen out;
    out.sample = tube_sample(rig.shape, wall.particle_spacing_mm, rig.thickness_mm, rig.seed);
    for (const Vec3& p : out.sample.position) {
        const double along = (p - rig.shape.start).dot(rig.shape.axis);
        out.held.push_back(along < held_mm || along > rig.shape.length_mm - held_mm ? 1 : 0);
    }
    out.gauges.push_back(tube_gauge(out.sample, rig));
    return out;
}

// Nothing is held: the loads of the lattice add up to nothing, and the strain is read from where the ring stands.
Specimen ring_specimen(const WallRig& rig, const SceneWall& wall) {
    TubeShape shape = rig.shape;
    shape.closed = false;
    shape.edge_mm = wall.particle_spacing_mm;
    Specimen out;
    out.sample = sample_of_mesh(tube_mesh(shape), rig.thickness_mm);
    out.sample.along.assign(out.sample.position.size(), shape.axis);
    out.held.assign(out.sample.position.size(), 0);
    out.gauges.push_back(tube_gauge(out.sample, rig));
    return out;
}

/// Adds the force of a stress on the row of points at x to the gauge, towards +x or -x.
void pull_row(const WallSample& sample, const WallRig& rig, double x, double sign, Gauge& gauge) {
    std::vector<std::pair<double, std::size_t>> row;  // y, particle
    for (std::size_t i = 0; i < sample.position.size(); ++i)
        if (std::fabs(sample.position[i].x() - x) < same_place) row.emplace_back(sample.position[i].y(), i);
    std::sort(row.begin(), row.end());
    // Each piece of the edge gives half of its force to either of its ends.
    for (std::size_t k = 1; k < row.size(); ++k) {
        const double half = 0.5 * sign * rig.thickness_mm * (row[k].first - row[k - 1].first);
        gauge.push[row[k - 1].second].x() += half;
        gauge.push[row[k].second].x() += half;
    }
}

/// Slope of the displacement along x over particles, by least squares.
std::function<double(std::span<const Vec3>)> stretch_of(const WallSample& sample, std::vector<std::size_t> particles) {
    std::vector<double> off;  // of the rest place from the mean
    double mean = 0.0, squares = 0.0;
    for (const std::size_t i : particles) mean += sample.position[i].x() / static_cast<double>(particles.size());
    for (const std::size_t i : particles) off.push_back(sample.position[i].x() - mean);
    for (const double d : off) squares += d * d;
    return [particles = std::move(particles), off = std::move(off), squares](std::span<const Vec3> x) {
        double sum = 0.0;
        for (std::size_t k = 0; k < particles.size(); ++k) sum += off[k] * x[particles[k]].x();
        return sum / squares - 1.0;
    };
}

/// Cut round the vessel, which then lies across the pull.
WallSample sheet_sample(const WallRig& rig, const SceneWall& wall) {
    WallSample out =
        sample_of_mesh(sheet_mesh(rig.length_mm, rig.width_mm, wall.particle_spacing_mm), rig.thickness_mm);
    out.along.assign(out.position.size(), Vec3::UnitY());
    return out;
}

Specimen strip_specimen(const WallRig& rig, const SceneWall& wall) {
    Specimen out;
    out.sample = sheet_sample(rig, wall);
    Gauge gauge{"strip", 0.0, rig.thickness_mm, std::vector<Vec3>(out.sample.position.size(), Vec3::Zero()), {}};
    std::vector<std::size_t> middle;
    for (std::size_t i = 0; i < out.sample.position.size(); ++i) {
        const double x = out.sample.position[i].x();
        out.held.push_back(x < same_place ? 1 : 0);
        if (std::fabs(x / rig.length_mm - 0.5) <= 1.0 / 6.0) middle.push_back(i);
    }
    pull_row(out.sample, rig, rig.length_mm, 1.0, gauge);
    gauge.strain = stretch_of(out.sample, std::move(middle));
    out.gauges.push_back(std::move(gauge));
    return out;
}

/// Smooth plates at the ends and guides at both faces leave a block stretch and width: all else is taken off, from
/// places and from speeds, particles weighed alike.
class EvenDeformation {
public:
    explicit EvenDeformation(std::vector<Vec3> rest) : rest_(std::move(rest)) {
        for (const Vec3& p : rest_) middle_ += p / static_cast<double>(rest_.size());
        for (Vec3& p : rest_) p -= middle_;
        for (const Vec3& p : rest_) squares_ += p.cwiseAbs2();
    }

    void operator()(std::span<Vec3> x, std::span<Vec3> v) const {
        const Vec3 stretch = slope(x), rate = slope(v);
        for (std::size_t i = 0; i < rest_.size(); ++i) {
            x[i] = middle_ + stretch.cwiseProduct(rest_[i]);
            v[i] = rate.cwiseProduct(rest_[i]);
        }
    }

private:
    Vec3 slope(std::span<const Vec3> values) const {
        Vec3 sum = Vec3::Zero();
        for (std::size_t i = 0; i < rest_.size(); ++i) sum += rest_[i].cwiseProduct(values[i]);
        return {sum.x() / squares_.x(), sum.y() / squares_.y(), 0.0};
    }

    std::vector<Vec3> rest_;
    Vec3 middle_ = Vec3::Zero(), squares_ = Vec3::Zero();
};

Specimen block_specimen(const WallRig& rig, const SceneWall& wall) {
    Specimen out;
    out.sample = sheet_sample(rig, wall);
    out.held.assign(out.sample.position.size(), 0);
    Gauge gauge{"block", 0.0, rig.thickness_mm, std::vector<Vec3>(out.sample.position.size(), Vec3::Zero()), {}};
    pull_row(out.sample, rig, 0.0, -1.0, gauge);
    pull_row(out.sample, rig, rig.length_mm, 1.0, gauge);
    std::vector<std::size_t> all(out.sample.position.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    gauge.strain = stretch_of(out.sample, std::move(all));
    out.gauges.push_back(std::move(gauge));
    out.guide = EvenDeformation(out.sample.position);
    return out;
}

}  // namespace

WallSample sample_of_mesh(const TriMesh& mesh, double thickness_mm) {
    const std::size_t n = mesh.vertices.size();
    WallSample out;
    out.position = mesh.vertices;
    out.normal = vertex_normals(mesh);
    out.area_mm2.assign(n, 0.0);
    out.thickness_mm.assign(n, thickness_mm);
    out.region.assign(n, 0);
    out.triangles = mesh.triangles;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.vertices[at(t[0])];
        const double third = (mesh.vertices[at(t[1])] - a).cross(mesh.vertices[at(t[2])] - a).norm() / 6.0;
        for (int k = 0; k < 3; ++k) {
            out.area_mm2[at(t[k])] += third;
            out.links.emplace_back(std::minmax(t[k], t[(k + 1) % 3]));
        }
    }
    std::sort(out.links.begin(), out.links.end());
    out.links.erase(std::unique(out.links.begin(), out.links.end()), out.links.end());
    return out;
}

TriMesh sheet_mesh(double length_mm, double width_mm, double edge_mm) {
    const auto rows = static_cast<Index>(std::max(1L, std::lround(length_mm / (0.87 * edge_mm))));
    const auto across = static_cast<Index>(std::max(1L, std::lround(width_mm / edge_mm)));
    // Even rows have points at k / across, odd ones halfway between and at both edges: the triangles are near to equal.
    TriMesh mesh;
    std::vector<Index> first;
    for (Index row = 0; row <= rows; ++row) {
        first.push_back(static_cast<Index>(mesh.vertices.size()));
        const double x = length_mm * row / rows;
        const bool odd = row % 2 != 0;
        for (Index k = 0; k <= across + (odd ? 1 : 0); ++k) {
            const double place = odd ? std::clamp(k - 0.5, 0.0, static_cast<double>(across)) : static_cast<double>(k);
            mesh.vertices.emplace_back(x, width_mm * place / across, 0.0);
        }
    }
    for (Index row = 0; row < rows; ++row) {
        const bool odd = row % 2 != 0;
        const Index even = first[at(odd ? row + 1 : row)], other = first[at(odd ? row : row + 1)];
        const auto add = [&](Index a, Index b, Index c) {  // as seen with the even row below
            if (odd)
                mesh.triangles.emplace_back(a, c, b);
            else
                mesh.triangles.emplace_back(a, b, c);
        };
        for (Index k = 0; k <= across; ++k) {
            add(even + k, other + k, other + k + 1);
            if (k < across) add(even + k, other + k + 1, even + k + 1);
        }
    }
    return mesh;
}

Gauge round_gauge(const WallSample& sample, const RoundGauge& round, RigStress stress, const std::string& name) {
    const auto refuse = [&](const std::string& why) { return UserError("'" + name + "': " + why); };
    if (round.loaded.empty() || round.read.empty())
        throw refuse("the rig has no wall there; particles that stand nearer to each other would help");
    const auto off = [&](Index i) -> Vec3 { return sample.position[at(i)] - round.centre[at(i)]; };
    Gauge out;
    out.name = name;
    out.push.assign(sample.position.size(), Vec3::Zero());
    for (const Index i : round.loaded) {
        const double radius = off(i).norm();
        if (!(radius > 1e-6)) throw refuse("the radius of the wall is 0");
        const double thin_wall = stress == RigStress::paper ? 1.0 : sample.thickness_mm[at(i)] / radius;
        out.push[at(i)] = sample.area_mm2[at(i)] * thin_wall / radius * off(i);
    }
    struct Read {
        std::size_t particle;
        Vec3 rest, centre;
        double radius, weight;  // by area: particles need not be spread evenly
    };
    std::vector<Read> reads;
    double area = 0.0;
    for (const Index i : round.read) area += sample.area_mm2[at(i)];
    const auto across = [axis = round.axis](const Vec3& p) -> Vec3 { return p - p.dot(axis) * axis; };
    for (const Index i : round.read) {
        const double radius = across(off(i)).norm();
        if (!(radius > 1e-6)) throw refuse("the radius of the wall is 0");
        const double weight = sample.area_mm2[at(i)] / area;
        reads.push_back({at(i), sample.position[at(i)], round.centre[at(i)], radius, weight});
        out.radius_mm += weight * radius;
        out.thickness_mm += weight * sample.thickness_mm[at(i)];
    }
    out.strain = [reads = std::move(reads), across](std::span<const Vec3> x) {
        Vec3 moved = Vec3::Zero();
        for (const Read& r : reads) moved += r.weight * (x[r.particle] - r.rest);
        double sum = 0.0;
        for (const Read& r : reads)
            sum += r.weight * (across(x[r.particle] - r.centre - moved).norm() / r.radius - 1.0);
        return sum;
    };
    return out;
}

Specimen make_specimen(const WallRig& rig, const SceneWall& wall) {
    check(rig);
    switch (rig.kind) {
        case RigKind::tube: return tube_specimen(rig, wall);
        case RigKind::ring: return ring_specimen(rig, wall);
        case RigKind::strip: return strip_specimen(rig, wall);
        case RigKind::block: return block_specimen(rig, wall);
        case RigKind::stations: break;
    }
    return station_specimen(*rig.stations, wall, rig.stress, rig.seed);
}

}  // namespace cathlab
