#include "contact/contact_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/check.h"

namespace cathlab {
namespace {

// A row that is open wider than this does not care where exactly it looks.
constexpr double near_mm = 0.1;

// What is deeper than this goes out by the shortest way.
constexpr double deep_mm = 0.25;

// Neighbouring samples that look at the same part of the wall, and the ball that they may fill.
constexpr std::size_t samples_together = 4;
constexpr double ball_mm = 12.0;

// Rows that are worth a thread of their own.
constexpr std::size_t row_grain = 48;

std::size_t at(Index i) {
    return static_cast<std::size_t>(i);
}
std::size_t at(std::int64_t i) {
    return static_cast<std::size_t>(i);
}

/// Hands the forces of a sample's old rows on to its new ones.  Each old row goes, the strongest first, to the new row
/// whose normal is nearest (within 60 degrees) and that no other went to, as the part of its force that points along
/// that normal: a force handed to two rows would push twice.
void warm_start(std::span<ChainRow> rows, std::span<const ChainRow> old_rows) {
    std::array<bool, max_rows_per_sample> given{}, taken{};
    for (std::size_t round = 0; round < old_rows.size(); ++round) {
        std::size_t strongest = old_rows.size();
        for (std::size_t o = 0; o < old_rows.size(); ++o) {
            if (given[o] || old_rows[o].multiplier <= 0.0) continue;
            if (strongest == old_rows.size() || old_rows[o].multiplier > old_rows[strongest].multiplier) strongest = o;
        }
        if (strongest == old_rows.size()) return;
        given[strongest] = true;
        const ChainRow& old = old_rows[strongest];
        std::size_t nearest = rows.size();
        double likeness = 0.5;
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const double cosine = old.normal.dot(rows[r].normal);
            if (taken[r] || cosine <= likeness) continue;
            likeness = cosine;
            nearest = r;
        }
        if (nearest == rows.size()) continue;
        taken[nearest] = true;
        ChainRow& row = rows[nearest];
        row.multiplier = likeness < 1.0 - 1e-12 ? old.multiplier * likeness : old.multiplier;
        row.tangent_force = into_cone(tangential(old.tangent_force, row.normal), row.friction * row.multiplier);
        row.held = tangential(old.held, row.normal);
    }
}

/// Particles that the corners of a triangle are bound to, at most.
std::size_t particles_at(const LumenSurfaceModel& model, Index triangle) {
    std::size_t sum = 0;
    for (int corner = 0; corner < 3; ++corner) {
        const std::size_t v = at(model.triangles[at(triangle)][corner]);
        sum += at(model.binding.start[v + 1] - model.binding.start[v]);
    }
    return sum;
}

/// Leaves for sample `first` (in the order of `place`) and those after it that lie in one small ball; the number of the
/// first sample beyond.
std::size_t gather_leaves(const LumenSurfaceModel& model, const LumenSurfaceState& surface,
                          std::span<const DeviceSample> samples, const std::vector<std::int64_t>& place,
                          std::size_t first, std::size_t end, double margin, NearLeaves& near) {
    const Vec3 centre = samples[at(place[std::min(first + samples_together / 2, end - 1)])].position;
    double radius = 0.0;
    std::size_t last = first;
    for (; last < std::min(end, first + samples_together); ++last) {
        const DeviceSample& s = samples[at(place[last])];
        const double reach = (s.position - centre).norm() + s.radius + margin;
        if (last > first && reach > ball_mm) break;
        radius = std::max(radius, reach);
    }
    near.gather(model.tree, surface.boxes, centre, radius);
    return last;
}

}  // namespace

struct ContactSet::Found {
    std::array<SurfacePoint, max_rows_per_sample> wall;
    Vec3 smooth = Vec3::Zero();  ///< normal for the nearest wall
    int count = 0;
    Index hint = -1;
    bool outside = false;  ///< the sample's centre lies beyond the wall
};

ContactSet::ContactSet(const ContactSettings& settings) : settings_(settings) {
    CATHLAB_CHECK(settings.recovery_mm > 0.0 && settings.min_compliance_mm_per_mn > 0.0 && settings.match_mm >= 0.0,
                  "contact settings must be positive");
    CATHLAB_CHECK(settings.rows_per_sample >= 1 && settings.rows_per_sample <= max_rows_per_sample,
                  "one to five rows a sample");
    memory_.first_row.push_back(0);
}

ContactSet::Found ContactSet::look(const LumenSurfaceModel& model, const LumenSurfaceState& surface,
                                   const DeviceSample& sample, Index hint, bool known_inside, WallSeen seen,
                                   double margin, const NearTriangles& near) const {
    Found found;
    const Vec3 motion = sample.position - sample.previous;
    const double moved = motion.norm();
    if (moved > 0.5 * margin) {
        // A sample that was pressed into the wall already has left: its own wall is the one it remembers.  Where walls
        // of two vessels overlap, the first exit ahead of it would be the neighbour's.
        const bool was_inside =
            hint < 0 || closest(model, surface, sample.previous, settings_.recovery_mm, hint).signed_distance >= 0.0;
        const auto exit = was_inside ? first_exit(model, surface, sample.previous, sample.position) : std::nullopt;
        if (exit) hint = exit->triangle;
    }
    const double reach = sample.radius + margin;
    // What was inside and moved little is inside still, or in reach of the wall that it went into: the many samples in
    // the middle of a wide vessel need not look at all of its walls.
    const bool look_far = !known_inside || moved > 0.5 * margin;
    seen.depth_mm += moved;
    const SurfacePoint nearest =
        look_far ? closest_credible(model, surface, sample.position, std::max(reach, settings_.recovery_mm + moved),
                                    hint, sample.radius, seen)
                 : closest_credible(model, surface, sample.position, reach, hint, sample.radius, seen, &near);
    found.hint = nearest.triangle;
    found.outside = nearest.found() && nearest.signed_distance < 0.0;
    if (!nearest.found() || nearest.signed_distance > reach || nearest.inward_normal.squaredNorm() < 0.5) return found;
    found.wall[static_cast<std::size_t>(found.count++)] = nearest;
    found.smooth = inward_smooth_normal(model, surface, nearest.triangle, nearest.barycentric);
    if (found.smooth.dot(nearest.inward_normal) < 0.5 || sample.radius - nearest.signed_distance > deep_mm)
        found.smooth = nearest.inward_normal;
    const int most = sample.walls > 0 ? std::min(sample.walls, max_rows_per_sample) : settings_.rows_per_sample;
    if (most < 2) return found;
    for (const SurfacePoint& wall :
         further_walls(model, surface, sample.position, reach, nearest, found.smooth, most - 1, &near)) {
        // Rows that look at each other across a fold would lock: the nearest wall alone decides on which side to stay.
        if (wall.inward_normal.dot(nearest.inward_normal) > 0.0)
            found.wall[static_cast<std::size_t>(found.count++)] = wall;
    }
    return found;
}

void ContactSet::detect(const LumenSurfaceModel& model, const LumenSurfaceState& surface,
                        std::span<const DeviceSample> samples, double margin, std::span<const Vec3> particles_before,
                        std::span<const double> particle_compliance, const Workers& workers, bool again) {
    CATHLAB_CHECK(margin > 0.0, "contact margin must be positive");
    CATHLAB_CHECK(
        particles_before.size() >= at(model.particle_count) && particle_compliance.size() == particles_before.size(),
        "one position and one compliance a particle");
    for (const DeviceSample& s : samples) {
        CATHLAB_CHECK(s.position.allFinite() && s.previous.allFinite() && s.arm.allFinite() && s.rotation.allFinite() &&
                          std::isfinite(s.arc_mm),
                      "a device sample must be finite");
        CATHLAB_CHECK(s.radius > 0.0 && std::isfinite(s.radius) && s.friction >= 0.0, "a device sample needs a radius");
    }
    const Memory old_memory = std::move(memory_);
    std::vector<ChainRow> old_rows = std::move(rows_);
    if (!again)
        for (ChainRow& row : old_rows) row.held = row.tangent_force;
    memory_ = {};
    rows_.clear();
    wall_.clear();
    particle_.clear();
    weight_.clear();

    const std::size_t n = samples.size();
    memory_.place.resize(n);
    std::iota(memory_.place.begin(), memory_.place.end(), 0);
    std::sort(memory_.place.begin(), memory_.place.end(), [&](std::int64_t a, std::int64_t b) {
        const DeviceSample& sa = samples[at(a)];
        const DeviceSample& sb = samples[at(b)];
        if (sa.device != sb.device) return sa.device < sb.device;
        return sa.arc_mm != sb.arc_mm ? sa.arc_mm < sb.arc_mm : a < b;
    });

    // Both lists are sorted: the nearest remembered sample of the same device is found in one walk.
    std::vector<std::int64_t> remembered(n, -1);
    std::size_t old = 0;
    const std::size_t old_count = old_memory.device.size();
    for (std::size_t i = 0; i < n; ++i) {
        const DeviceSample& s = samples[at(memory_.place[i])];
        const auto before = [&](std::size_t o) {
            return old_memory.device[o] < s.device ||
                   (old_memory.device[o] == s.device && old_memory.arc[o] <= s.arc_mm);
        };
        while (old < old_count && before(old)) ++old;
        double nearest = settings_.match_mm;
        for (std::size_t o = old > 0 ? old - 1 : 0; o < std::min(old + 1, old_count); ++o) {
            const double distance = std::fabs(old_memory.arc[o] - s.arc_mm);
            if (old_memory.device[o] == s.device && distance < nearest) {
                nearest = distance;
                remembered[i] = static_cast<std::int64_t>(o);
            }
        }
    }

    std::vector<Found> found(n);
    const auto triangles = static_cast<Index>(model.triangles.size());
    workers.for_ranges(n, 4 * samples_together, [&](std::size_t begin, std::size_t end) {
        NearLeaves leaves;
        NearTriangles near;
        std::size_t together = begin;  // `leaves` serve the samples before this one
        for (std::size_t i = begin; i < end; ++i) {
            const DeviceSample& s = samples[at(memory_.place[i])];
            if (i == together) {
                together = gather_leaves(model, surface, samples, memory_.place, i, end, margin, leaves);
            }
            Index hint = s.hint;
            bool known_inside = false;
            WallSeen seen;
            if (remembered[i] >= 0) {
                const std::size_t sample = at(remembered[i]), place = at(old_memory.place[sample]);
                if (hint < 0) hint = old_memory.triangle[place];
                known_inside = old_memory.outside[place] == 0;
                const std::size_t row = at(old_memory.first_row[sample]);
                seen = wall_seen(std::span(old_rows).subspan(row, at(old_memory.first_row[sample + 1]) - row));
            }
            near.gather(model.tree, surface.boxes, leaves, s.position, s.radius + margin);
            found[i] = look(model, surface, s, hint < triangles ? hint : -1, known_inside, seen, margin, near);
        }
    });

    // Rows, one sample beside the other: where each one's begin is known, and how many particles they may need at most.
    memory_.triangle.assign(n, -1);
    memory_.outside.assign(n, 0);
    memory_.device.resize(n);
    memory_.arc.resize(n);
    memory_.first_row.resize(n + 1);
    sample_before_.resize(n);
    std::size_t count = 0;
    for (std::size_t i = 0; i < n; ++i) {
        memory_.first_row[i] = static_cast<std::int64_t>(count);
        count += static_cast<std::size_t>(found[i].count);
    }
    memory_.first_row[n] = static_cast<std::int64_t>(count);
    rows_.resize(count);
    wall_.resize(count);
    room_.resize(count + 1);
    room_[0] = 0;
    for (std::size_t i = 0; i < n; ++i)
        for (int k = 0; k < found[i].count; ++k) {
            const std::size_t r = at(memory_.first_row[i]) + static_cast<std::size_t>(k);
            room_[r + 1] = room_[r] + particles_at(model, found[i].wall[static_cast<std::size_t>(k)].triangle);
        }
    particle_.resize(room_.back());
    weight_.resize(room_.back());
    workers.for_ranges(n, 2 * samples_together, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::size_t place = at(memory_.place[i]);
            const DeviceSample& s = samples[place];
            memory_.device[i] = s.device;
            memory_.arc[i] = s.arc_mm;
            memory_.triangle[place] = found[i].hint;
            memory_.outside[place] = found[i].outside ? 1 : 0;
            sample_before_[place] = s.previous;
            const std::size_t first = at(memory_.first_row[i]);
            for (int k = 0; k < found[i].count; ++k)
                make_row(model, s, found[i], k, static_cast<Index>(place), particles_before,
                         first + static_cast<std::size_t>(k));
            if (remembered[i] < 0) continue;
            const std::size_t old_first = at(old_memory.first_row[at(remembered[i])]);
            const std::size_t old_last = at(old_memory.first_row[at(remembered[i]) + 1]);
            warm_start(std::span<ChainRow>(rows_).subspan(first, static_cast<std::size_t>(found[i].count)),
                       std::span<const ChainRow>(old_rows).subspan(old_first, old_last - old_first));
        }
    });
    close_ranks();
    set_compliance(particle_compliance, workers);
}

void ContactSet::make_row(const LumenSurfaceModel& model, const DeviceSample& s, const Found& found, int k, Index place,
                          std::span<const Vec3> particles_before, std::size_t r) {
    const SurfacePoint& at_wall = found.wall[static_cast<std::size_t>(k)];
    WallRow& wall = wall_[r];
    wall.sample = place;
    wall.device = s.device;
    wall.triangle = at_wall.triangle;
    wall.region = model.triangle_region[at(at_wall.triangle)];
    wall.kinematic = s.kinematic;
    wall.radius = s.radius;
    wall.arc_mm = s.arc_mm;
    wall.barycentric = at_wall.barycentric;
    wall.begin = wall.end = room_[r];
    for (int corner = 0; corner < 3; ++corner) {
        const std::size_t v = at(model.triangles[at(at_wall.triangle)][corner]);
        for (Index b = model.binding.start[v]; b < model.binding.start[v + 1]; ++b) {
            const Index particle = model.binding.particle[at(b)];
            const double weight = at_wall.barycentric[corner] * model.binding.weight[at(b)];
            std::size_t slot = wall.begin;  // neighbours share most of their particles
            while (slot < wall.end && particle_[slot] != particle) ++slot;
            if (slot < wall.end) {
                weight_[slot] += weight;
            } else if (weight != 0.0) {
                particle_[wall.end] = particle;
                weight_[wall.end++] = weight;
            }
        }
    }
    wall.point_before = Vec3::Zero();
    for (std::size_t j = wall.begin; j < wall.end; ++j)
        wall.point_before += weight_[j] * particles_before[at(particle_[j])];
    wall.point = at_wall.point;
    wall.found = s.position - at_wall.point;
    wall.separation = wall.found;
    ChainRow& row = rows_[r];
    row.link = s.link;
    row.normal = k == 0 ? found.smooth : at_wall.inward_normal;
    wall.offset = row.normal.dot(s.position - at_wall.point) - (at_wall.signed_distance - s.radius);
    row.gap = at_wall.signed_distance - s.radius;
    row.friction = s.friction;
}

// The rows' particles without the places that none of them took.
void ContactSet::close_ranks() {
    std::size_t last = 0;
    for (WallRow& wall : wall_) {
        const std::size_t begin = last;
        for (std::size_t j = wall.begin; j < wall.end; ++j, ++last) {
            particle_[last] = particle_[j];
            weight_[last] = weight_[j];
        }
        wall.begin = begin;
        wall.end = last;
    }
    particle_.resize(last);
    weight_.resize(last);
}

void ContactSet::set_compliance(std::span<const double> particle_compliance, const Workers& workers) {
    touching_.resize(particle_compliance.size(), 0);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        if (wall_[r].kinematic || !(rows_[r].multiplier > 0.0 || rows_[r].gap < near_mm)) continue;
        for (std::size_t j = wall_[r].begin; j < wall_[r].end; ++j) ++touching_[at(particle_[j])];
    }
    workers.for_ranges(rows_.size(), row_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t r = begin; r < end; ++r) {
            double compliance = 0.0;
            for (std::size_t j = wall_[r].begin; j < wall_[r].end; ++j) {
                const std::size_t p = at(particle_[j]);
                compliance += weight_[j] * weight_[j] * particle_compliance[p] * std::max<Index>(1, touching_[p]);
            }
            rows_[r].compliance = std::max(compliance, settings_.min_compliance_mm_per_mn);
        }
    });
    touched_.clear();
    for (const Index p : particle_) {
        if (touching_[at(p)] < 0) continue;
        touching_[at(p)] = -1;
        touched_.push_back(p);
    }
    for (const Index p : touched_) touching_[at(p)] = 0;
}

void ContactSet::refresh(std::span<const DeviceSample> samples_now, std::span<const Vec3> particles_now,
                         const Workers& workers) {
    CATHLAB_CHECK(samples_now.size() == sample_before_.size(), "refresh takes the samples of detect");
    workers.for_ranges(rows_.size(), row_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t r = begin; r < end; ++r) {
            ChainRow& row = rows_[r];
            WallRow& wall = wall_[r];
            const DeviceSample& s = samples_now[at(wall.sample)];
            Vec3 q = Vec3::Zero();
            for (std::size_t j = wall.begin; j < wall.end; ++j) q += weight_[j] * particles_now[at(particle_[j])];
            wall.point = q;
            wall.separation = s.position - q;
            row.gap = row.normal.dot(s.position - q) - wall.offset;
            // Forces act where the surfaces meet, so friction also turns the device about its axis.
            row.arm = s.arm - wall.radius * row.normal;
            const Vec3 relative = (s.position - sample_before_[at(wall.sample)]) - (q - wall.point_before) -
                                  wall.radius * s.rotation.cross(row.normal);
            row.slip = tangential(relative, row.normal);
        }
    });
}

double ContactSet::deepest(Index device) const {
    double depth = 0.0;
    for (std::size_t r = 0; r < rows_.size(); ++r)
        if (wall_[r].device == device) depth = std::max(depth, -rows_[r].gap);
    return depth;
}

double ContactSet::staleness() const {
    double worst = 0.0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        if (rows_[r].multiplier <= 0.0 && rows_[r].gap > near_mm) continue;
        const Vec3 shift = tangential(Vec3(wall_[r].separation - wall_[r].found), rows_[r].normal);
        worst = std::max(worst, shift.squaredNorm());
    }
    return std::sqrt(worst);
}

std::vector<double> ContactSet::arcs_at_the_wall(Index device) const {
    std::vector<double> arcs;
    for (std::size_t i = 0; i < memory_.device.size(); ++i)
        if (memory_.device[i] == device && memory_.first_row[i + 1] > memory_.first_row[i])
            arcs.push_back(memory_.arc[i]);
    return arcs;
}

std::span<ChainRow> ContactSet::chain_rows(Index device) {
    const auto range =
        std::equal_range(memory_.device.begin(), memory_.device.end(), static_cast<std::int64_t>(device));
    const std::int64_t begin = memory_.first_row[static_cast<std::size_t>(range.first - memory_.device.begin())];
    const std::int64_t end = memory_.first_row[static_cast<std::size_t>(range.second - memory_.device.begin())];
    return std::span<ChainRow>(rows_).subspan(at(begin), at(end - begin));
}

void ContactSet::yield(Index device, std::span<const ChainRow> before, std::span<Vec3> particles,
                       std::span<const double> particle_compliance) const {
    std::size_t k = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        if (wall_[r].device != device) continue;
        const ChainRow& old = before[k++];
        const Vec3 change =
            (rows_[r].multiplier - old.multiplier) * rows_[r].normal + (rows_[r].tangent_force - old.tangent_force);
        for (std::size_t j = wall_[r].begin; j < wall_[r].end; ++j) {
            const std::size_t p = at(particle_[j]);
            particles[p] -= particle_compliance[p] * weight_[j] * change;
        }
    }
}

void ContactSet::add_touched(std::vector<Index>& particles) const {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        if (rows_[r].multiplier <= 0.0 && rows_[r].gap > near_mm) continue;
        particles.insert(particles.end(), particle_.begin() + static_cast<std::ptrdiff_t>(wall_[r].begin),
                         particle_.begin() + static_cast<std::ptrdiff_t>(wall_[r].end));
    }
}

void ContactSet::apply_to_wall(std::span<Vec3> force) const {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        const ChainRow& row = rows_[r];
        if (row.multiplier == 0.0 && row.tangent_force.isZero(0.0)) continue;
        const Vec3 on_device = row.multiplier * row.normal + row.tangent_force;
        for (std::size_t j = wall_[r].begin; j < wall_[r].end; ++j) force[at(particle_[j])] -= weight_[j] * on_device;
    }
}

void ContactSet::clear() {
    *this = ContactSet(settings_);
}

void visit(Archive& archive, ContactSet& set) {
    std::vector<double> multiplier;
    std::vector<Vec3> normal, tangent;
    for (const ChainRow& row : set.rows_) {
        multiplier.push_back(row.multiplier);
        normal.push_back(row.normal);
        tangent.push_back(row.tangent_force);
    }
    std::vector<std::int64_t> triangle(set.memory_.triangle.begin(), set.memory_.triangle.end());
    archive.field("device", set.memory_.device);
    archive.field("arc_mm", set.memory_.arc);
    archive.field("triangle", triangle);
    archive.field("outside", set.memory_.outside);
    archive.field("first_row", set.memory_.first_row);
    archive.field("multiplier_mn", multiplier);
    archive.field("normal", normal);
    archive.field("tangent_force_mn", tangent);
}

}  // namespace cathlab
