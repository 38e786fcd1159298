// A tendon can pull and not push: one that is paid out goes slack and no longer bends its segment [camarillo2009].  The
// segment takes the least bend b that every tendon at least as short as its drive makes it allows,
//     minimise |b|^2   subject to   r b . e_j >= l_j - slack   for all tendons j,
// e_j the direction of tendon j, r its distance from the axis, l_j the length pulled.  `share` is the part of the
// segment's bend that obeys this law, the rest being that of ideal tendons (the least squares of all of them).
#include <cmath>

#include "core/deterministic_math.h"
#include "effects/effect.h"

namespace cathlab {
namespace {

struct Pull {
    Vec2 direction;
    double bend;  // at least, rad
};

bool allowed(const std::vector<Pull>& pulls, const Vec2& b) {
    for (const Pull& p : pulls)
        if (p.direction.dot(b) < p.bend - 1e-12) return false;
    return true;
}

/// The least bend within the half-planes: none, one or two of them hold it.  Where no bend satisfies all (tendons
/// pulled against one another) they stretch: what the least squares of those that pull leaves.
Vec2 least_bend(const std::vector<Pull>& pulls) {
    if (allowed(pulls, Vec2::Zero())) return Vec2::Zero();
    const Pull* strongest = &pulls.front();
    for (const Pull& p : pulls)
        if (p.bend > strongest->bend) strongest = &p;
    const Vec2 alone = strongest->bend * strongest->direction;
    if (allowed(pulls, alone)) return alone;
    Vec2 best = Vec2::Zero();
    double least = -1.0;
    for (std::size_t i = 0; i < pulls.size(); ++i)
        for (std::size_t j = i + 1; j < pulls.size(); ++j) {
            const Vec2 &a = pulls[i].direction, &c = pulls[j].direction;
            const double cross = a.x() * c.y() - a.y() * c.x();
            if (std::fabs(cross) < 1e-9) continue;
            const Vec2 b((pulls[i].bend * c.y() - pulls[j].bend * a.y()) / cross,
                         (pulls[j].bend * a.x() - pulls[i].bend * c.x()) / cross);
            if ((least < 0.0 || b.squaredNorm() < least) && allowed(pulls, b)) {
                best = b;
                least = b.squaredNorm();
            }
        }
    if (least >= 0.0) return best;
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Vec2 right = Vec2::Zero();
    for (const Pull& p : pulls) {
        if (p.bend <= 0.0) continue;
        normal += p.direction * p.direction.transpose();
        right += p.bend * p.direction;
    }
    const double d = normal.determinant();
    return d > 1e-9 ? Vec2(normal.inverse() * right) : alone;
}

class TendonSlack final : public Effect {
public:
    explicit TendonSlack(std::span<const double> p) : share_(p[0]), slack_mm_(p[1]) {}

    void actuation(const EffectContext& /*context*/, Actuation& act) override {
        for (ActuatedSegment& s : act.segments) {
            const std::size_t n = s.tendon_mm.size();
            if (n < 2 || s.tendon_radius_mm <= 0.0) continue;
            pulls_.clear();
            Vec2 ideal = Vec2::Zero();
            for (std::size_t j = 0; j < n; ++j) {
                const Vec2 e(det::cos(s.tendon_rad[j]), det::sin(s.tendon_rad[j]));
                ideal += 2.0 / (static_cast<double>(n) * s.tendon_radius_mm) * s.tendon_mm[j] * e;
                pulls_.push_back({e, (s.tendon_mm[j] - slack_mm_) / s.tendon_radius_mm});
            }
            s.bend_rad += share_ * (least_bend(pulls_) - ideal);
        }
    }

private:
    double share_, slack_mm_;
    std::vector<Pull> pulls_;  // scratch
};

}  // namespace

EffectInfo tendon_slack_effect() {
    return {
        .name = "tendon_slack",
        .doc = "a tendon pulls and cannot push: one that is paid out goes slack",
        .source = "camarillo2009",
        .hooks = hook_actuation,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip"},
        .parameters = {{"share", "1", 1.0, 0.0, 1.0,
                        "part of the bend that obeys the law; 1 = tendons that cannot push"},
                       {"slack_mm", "mm", 0.0, -8.0, 8.0,
                        "length to be pulled before a tendon of the straight segment "
                        "is taut; below 0 = pretensioned"}},
        .strengths = {"share"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<TendonSlack>(p); },
    };
}

}  // namespace cathlab
