#include "contact/inside_catheter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "core/check.h"

namespace cathlab {
namespace {

constexpr double window_mm = 10.0;

struct Foot {
    Vec3 point;
    Vec3 tangent;
};

Foot nearest_foot(const CatheterBore& bore, const Vec3& p, double arc) {
    const auto begin = static_cast<std::size_t>(std::lower_bound(bore.arc.begin(), bore.arc.end(), arc - window_mm) -
                                                bore.arc.begin());
    Foot best{bore.points.back(), Vec3::UnitZ()};
    double best_distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = begin == 0 ? 0 : begin - 1; i + 1 < bore.points.size(); ++i) {
        if (bore.arc[i] > arc + window_mm) break;
        const Vec3 edge = bore.points[i + 1] - bore.points[i];
        const double length2 = edge.squaredNorm();
        if (length2 == 0.0) continue;
        const double t = std::clamp((p - bore.points[i]).dot(edge) / length2, 0.0, 1.0);
        const Vec3 foot = bore.points[i] + t * edge;
        const double d = (p - foot).squaredNorm();
        if (d < best_distance) {
            best_distance = d;
            best = {foot, edge / std::sqrt(length2)};
        }
    }
    return best;
}

}  // namespace

bool inside_bore(const CatheterBore& bore, double arc_from_mouth) {
    return bore.arc.size() >= 2 && arc_from_mouth >= 0.0 && arc_from_mouth <= bore.arc.back();
}

void add_bore_rows(const CatheterBore& bore, std::span<const RodSample> samples, std::span<const double> arc_from_mouth,
                   double spacing_mm, double compliance, std::vector<ChainRow>& rows) {
    CATHLAB_CHECK(samples.size() == arc_from_mouth.size(), "one arc length a sample");
    CATHLAB_CHECK(bore.points.size() == bore.arc.size(), "one arc length a point of the bore");
    double last = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!inside_bore(bore, arc_from_mouth[i]) || std::fabs(last - arc_from_mouth[i]) < spacing_mm) continue;
        last = arc_from_mouth[i];
        const Foot foot = nearest_foot(bore, samples[i].position, arc_from_mouth[i]);
        const Vec3 offset = samples[i].position - foot.point;
        const Vec3 seed = std::fabs(foot.tangent.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY();
        const Vec3 across = foot.tangent.cross(seed).normalized();
        for (const Vec3& normal : {across, Vec3(foot.tangent.cross(across))}) {
            ChainRow row;
            row.link = samples[i].link;
            row.arm = samples[i].arm;
            row.normal = normal;
            row.gap = offset.dot(normal);
            row.compliance = compliance;
            row.bilateral = true;
            rows.push_back(row);
        }
    }
}

void add_outside_rows(const CatheterOutside& catheter, std::span<const RodSample> samples,
                      std::span<const SampleMotion> motion, std::span<const std::size_t> beside,
                      std::vector<ChainRow>& rows) {
    CATHLAB_CHECK(motion.size() == samples.size(), "one motion a sample");
    CATHLAB_CHECK(catheter.line_before.empty() || catheter.line_before.size() == catheter.line.points.size(),
                  "one earlier place a point of the catheter");
    CATHLAB_CHECK(catheter.radius_mm > 0.0 && catheter.compliance > 0.0, "a catheter's wall has a radius and yields");
    const std::span<const Vec3> line = catheter.line.points;
    CATHLAB_CHECK(line.size() == catheter.line.arc.size(), "one arc length a point of the catheter");
    if (line.size() < 2) return;
    Vec3 low = line.front(), high = low;
    for (const Vec3& p : line) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    for (const std::size_t k : beside) {
        const RodSample& s = samples[k];
        const double touching = catheter.radius_mm + s.radius, reach = touching + catheter.margin_mm;
        if (((low.array() - reach) > s.position.array()).any() || ((high.array() + reach) < s.position.array()).any())
            continue;
        double best = reach * reach;
        Vec3 foot = Vec3::Zero(), along = Vec3::Zero(), foot_way = Vec3::Zero();
        bool found = false, first = true;
        for (std::size_t i = 0; i + 1 < line.size(); ++i) {
            const Vec3 edge = line[i + 1] - line[i];
            const double length2 = edge.squaredNorm();
            if (catheter.line.arc[i] < catheter.near_mouth_mm || length2 == 0.0) continue;
            const double part = (s.position - line[i]).dot(edge) / length2;
            const double share = std::clamp(part, 0.0, 1.0);
            const Vec3 point = line[i] + share * edge;
            const double d = (s.position - point).squaredNorm();
            if (d < best) {
                best = d;
                foot = point;
                along = edge;
                if (!catheter.line_before.empty()) {
                    const Vec3& a = catheter.line_before[i];
                    foot_way = point - (a + share * (catheter.line_before[i + 1] - a));
                }
                found = !(first && part < 0.0);  // beside it, not in the mouth
            }
            first = false;
        }
        if (!found) continue;
        Vec3 away = s.position - foot;
        double distance = away.norm();
        if (distance < 1e-9) {
            away = along.cross(std::fabs(along.x()) < 0.7 * along.norm() ? Vec3::UnitX() : Vec3::UnitY());
            distance = away.norm();
            away /= distance;
            distance = 0.0;
        } else {
            away /= distance;
        }
        ChainRow row;
        row.link = s.link;
        row.normal = away;
        row.arm = s.arm - s.radius * away;
        row.gap = std::max(distance - touching, -catheter.deepest_mm);
        row.compliance = catheter.compliance;
        row.friction = catheter.friction;
        const Vec3 slip = motion[k].way - foot_way - s.radius * motion[k].rotation.cross(away);
        row.slip = slip - slip.dot(away) * away;
        rows.push_back(row);
    }
}

}  // namespace cathlab
