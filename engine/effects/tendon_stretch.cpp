// Tendons are springs: they stretch, they run through every segment before their own and bend those too, and they pull
// and cannot push [camarillo2008].  With b_i the bend of segment i (base first), a_i that of its backbone left alone,
// e_j the direction of tendon j of segment k, l_j the length pulled, r its distance from the axis and p what it is
// tightened by, the bends are the least of
//     sum_i  give |b_i - a_i|^2 / 2  +  sum_j  max(0, (l_j + p) / r - e_j . (b_1 + ... + b_k))^2 / 2,
// give the stiffness of a segment in bending over that of one tendon (times r^2).  `share` is the part of the bends
// that obeys this law, the rest being that of ideal tendons.
#include <Eigen/Cholesky>
#include <cmath>

#include "core/deterministic_math.h"
#include "effects/effect.h"

namespace cathlab {
namespace {

constexpr Eigen::Index most_segments = 8;
using Bends = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * most_segments, 1>;
using Stiffness = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2 * most_segments, 2 * most_segments>;

struct Tendon {
    Eigen::Index segment;
    Vec2 direction;
    double place_rad;
    double pulled;  // (l + p) / r
};

class TendonStretch final : public Effect {
public:
    explicit TendonStretch(std::span<const double> p) : share_(p[0]), give_(p[1]), tight_mm_(p[2]) {}

    void actuation(const EffectContext& /*context*/, Actuation& act) override {
        const auto n = static_cast<Eigen::Index>(act.segments.size());
        if (share_ == 0.0 || n == 0 || n > most_segments || !lead(act)) return;
        Bends ideal = Bends::Zero(2 * n), alone(2 * n);
        std::size_t at = 0;
        for (Eigen::Index i = 0; i < n; ++i) {
            const ActuatedSegment& s = act.segments[static_cast<std::size_t>(i)];
            const double part = 2.0 / (static_cast<double>(s.tendon_mm.size()) * s.tendon_radius_mm);
            for (const double pulled : s.tendon_mm) {
                Tendon& t = tendons_[at++];
                t.pulled = (pulled + tight_mm_) / s.tendon_radius_mm;
                ideal.segment<2>(2 * i) += part * pulled * t.direction;
            }
            // The drive's rest shape, and what other effects made of it.
            alone.segment<2>(2 * i) = s.bend_rad - ideal.segment<2>(2 * i);
        }
        if (bends_.size() != 2 * n) bends_ = alone;
        balance(alone);
        for (Eigen::Index i = 0; i < n; ++i)
            act.segments[static_cast<std::size_t>(i)].bend_rad +=
                share_ * (bends_.segment<2>(2 * i) - ideal.segment<2>(2 * i) - alone.segment<2>(2 * i));
    }

    void visit(Archive& archive) override {
        for (Eigen::Index i = 0; i < bends_.size(); ++i) archive.field("bend_rad", bends_[i]);
    }

private:
    /// Where the tendons run; false where the device has none.
    bool lead(const Actuation& act) {
        std::size_t at = 0;
        for (std::size_t i = 0; i < act.segments.size(); ++i) {
            const ActuatedSegment& s = act.segments[i];
            if (s.tendon_mm.size() < 2 || s.tendon_radius_mm <= 0.0) return false;
            for (const double place : s.tendon_rad) {
                if (at == tendons_.size()) tendons_.push_back({0, Vec2(1.0, 0.0), 0.0, 0.0});
                Tendon& t = tendons_[at++];
                t.segment = static_cast<Eigen::Index>(i);
                if (t.place_rad == place) continue;
                t.direction = Vec2(det::cos(place), det::sin(place));
                t.place_rad = place;
            }
        }
        tendons_.resize(at);
        return true;
    }

    /// b_1, b_1 + b_2, ...
    static Bends sums(const Bends& b) {
        Bends out = b;
        for (Eigen::Index i = 2; i < b.size(); i += 2) out.segment<2>(i) += out.segment<2>(i - 2);
        return out;
    }

    double energy(const Bends& alone, const Bends& b) const {
        double sum = give_ * (b - alone).squaredNorm();
        const Bends turned = sums(b);
        for (const Tendon& t : tendons_) {
            const double stretch = t.pulled - t.direction.dot(turned.segment<2>(2 * t.segment));
            if (stretch > 0.0) sum += stretch * stretch;
        }
        return 0.5 * sum;
    }

    /// The least of the energy with those tendons that are taut at b.
    Bends least(const Bends& alone, const Bends& b) const {
        Stiffness matrix = give_ * Stiffness::Identity(b.size(), b.size());
        Bends right = give_ * alone;
        const Bends turned = sums(b);
        Eigen::Matrix2d along = Eigen::Matrix2d::Zero();  // of the taut tendons of this segment and those beyond
        Vec2 pulled = Vec2::Zero();
        std::size_t k = tendons_.size();
        for (Eigen::Index i = b.size() - 2; i >= 0; i -= 2) {
            for (; k > 0 && 2 * tendons_[k - 1].segment == i; --k) {
                const Tendon& t = tendons_[k - 1];
                if (t.pulled - t.direction.dot(turned.segment<2>(i)) <= 0.0) continue;
                along += t.direction * t.direction.transpose();
                pulled += t.pulled * t.direction;
            }
            right.segment<2>(i) += pulled;
            matrix.block<2, 2>(i, i) += along;
            for (Eigen::Index j = 0; j < i; j += 2) {
                matrix.block<2, 2>(i, j) += along;
                matrix.block<2, 2>(j, i) += along;
            }
        }
        return matrix.llt().solve(right);
    }

    /// Newton's steps from one set of taut tendons to the next, halved where they overshoot: the energy is convex and
    /// made of parabolas, so that the last step is exact.  Begins where the tendons stood before.
    void balance(const Bends& alone) {
        constexpr int most_steps = 30, most_halvings = 8;
        double now = energy(alone, bends_);
        for (int step = 0; step < most_steps; ++step) {
            const Bends way = least(alone, bends_) - bends_;
            if (way.squaredNorm() < 1e-24) break;
            double part = 1.0, next = energy(alone, bends_ + way);
            for (int k = 0; k < most_halvings && next > now; ++k) {
                part *= 0.5;
                next = energy(alone, bends_ + part * way);
            }
            if (next > now) break;  // as low as numbers go
            bends_ += part * way;
            now = next;
        }
    }

    double share_, give_, tight_mm_;
    std::vector<Tendon> tendons_;  // base first
    Bends bends_;                  // where they stood last
};

}  // namespace

EffectInfo tendon_stretch_effect() {
    return {
        .name = "tendon_stretch",
        .doc = "tendons stretch, bend every segment that they run through, and pull without pushing",
        .source = "camarillo2008",
        .hooks = hook_actuation,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip"},
        .parameters = {{"share", "1", 1.0, 0.0, 1.0, "part of the bends that obeys the law; 1 = all"},
                       {"give", "1", 0.3, 0.01, 20.0, "stiffness of a segment in bending over that of one tendon"},
                       {"tight_mm", "mm", 0.0, -8.0, 8.0,
                        "length by which each tendon of the straight device is tightened; below 0 = slack"}},
        .strengths = {"share"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<TendonStretch>(p); },
    };
}

}  // namespace cathlab
