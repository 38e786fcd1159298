// What is slack bears nothing until it is straight: of each principal (Green) strain e the part between 0 and `strain`
// is taken away before the elastic law sees it [fung1993],
//     e_elastic = e - clamp(e, 0, strain),
// for a wall in folds or a strip that hangs between its grips.  strain < 0: the same in compression, as of a specimen
// that its platens do not touch yet.  `remnant` of the wall's stiffness stays within the slack: what it takes to unfold
// it, and nothing can be solved without any.  The folds bear what the rest of the wall bears: where that has a memory
// they close again when the tension is gone, and not when the strain is.
#include <algorithm>
#include <cmath>

#include "effects/effect.h"

namespace cathlab {
namespace {

/// Green's strain in its own axes, the first along (cosine, sine) / 2 of the double angle.
struct Principal {
    explicit Principal(const Vec3& c) {
        const double xx = 0.5 * (c[0] - 1.0), yy = 0.5 * (c[1] - 1.0), xy = 0.5 * c[2];
        const double middle = 0.5 * (xx + yy), half = 0.5 * (xx - yy);
        const double radius = std::sqrt(half * half + xy * xy);
        strain = Vec2(middle + radius, middle - radius);
        cosine = radius > 0.0 ? half / radius : 1.0;
        sine = radius > 0.0 ? xy / radius : 0.0;
    }
    /// Twice the tensor with these values along the axes.
    Vec3 twice(const Vec2& v) const {
        const double mean = v[0] + v[1], apart = v[0] - v[1];
        return {mean + apart * cosine, mean - apart * cosine, apart * sine};
    }
    /// Of a tensor, its component along axis k.
    double along(const Vec3& t, int k) const {
        const double middle = 0.5 * (t[0] + t[1]), half = 0.5 * (t[0] - t[1]);
        const double turned = half * cosine + t[2] * sine;
        return k == 0 ? middle + turned : middle - turned;
    }
    Vec2 strain;
    double cosine, sine;
};

class Slack final : public Effect {
public:
    Slack(double strain, double remnant) : strain_(strain), remnant_(remnant) {}

    void strain(const EffectContext& /*context*/, MembranePoint& point) override {
        if (strain_ == 0.0) return;
        const Principal e(point.c);
        point.c -= e.twice({taken(e.strain[0]), taken(e.strain[1])});
    }

    void share(const EffectContext& /*context*/, const Vec3& c, const RestOfWall& rest, MembranePoint& point) override {
        if (strain_ == 0.0) return;
        const Principal e(c);
        Vec2 folds(taken(e.strain[0]), taken(e.strain[1]));
        for (int k = 0; k < 2; ++k)
            if (folds[k] != 0.0) balance(e, k, rest, folds, point);
    }

private:
    double taken(double e) const {
        return (1.0 - remnant_) * std::clamp(e, std::min(0.0, strain_), std::max(0.0, strain_));
    }

    /// What the rest bears along axis k over what the folds do, in the direction of the slack.
    double excess(const Principal& e, int k, const RestOfWall& rest, const Vec2& folds,
                  const MembranePoint& point) const {
        MembranePoint unfolding;
        Vec2 strain = e.strain - folds;
        const double unfolded = remnant_ / (1.0 - remnant_) * folds[k];
        strain[1 - k] += rest.poisson() * (strain[k] - unfolded);  // folds are free to the side as the wall is
        strain[k] = unfolded;
        unfolding.c = Vec3(1, 1, 0) + e.twice(strain);
        rest.ask_elastic(unfolding);
        const double over = e.along(point.stress, k) - e.along(unfolding.stress, k);
        return strain_ > 0.0 ? over : -over;
    }

    void balance(const Principal& e, int k, const RestOfWall& rest, Vec2& folds, MembranePoint& point) const {
        constexpr double nothing = 1e-6;  // of the shear modulus
        constexpr int most_steps = 40;
        const double full = (1.0 - remnant_) * strain_, first = excess(e, k, rest, folds, point);
        const double small = nothing * point.mu_kpa;
        if (std::fabs(first) <= small || (first > 0.0 && folds[k] == full)) return;
        const auto at = [&](double fold) {
            folds[k] = fold;
            point = MembranePoint{.index = point.index, .c = Vec3(1, 1, 0) + e.twice(e.strain - folds)};
            rest.ask(point);
            return excess(e, k, rest, folds, point);
        };
        double low = first > 0.0 ? folds[k] : 0.0, high = first > 0.0 ? full : folds[k];
        double above = first > 0.0 ? first : at(low), below = first > 0.0 ? at(high) : first;
        if (above <= small || below >= -small) {
            if (above <= small) at(low);
            return;
        }
        // The fold at which both bear alike, by the false position's better half [dowell1971].
        for (int step = 0, side = 0; step < most_steps; ++step) {
            const double fold = (low * below - high * above) / (below - above), now = at(fold);
            if (std::fabs(now) <= small) return;
            if (now > 0.0) {
                low = fold;
                above = now;
                if (side > 0) below *= 0.5;
                side = 1;
            } else {
                high = fold;
                below = now;
                if (side < 0) above *= 0.5;
                side = -1;
            }
        }
    }

    double strain_, remnant_;
};

}  // namespace

EffectInfo slack_effect() {
    return {
        .name = "slack",
        .doc = "the wall bears nothing until it is pulled straight",
        .source = "fung1993",
        .hooks = hook_membrane,
        .for_tests = false,
        .applies_to = {"wall-tension", "wall-contact"},
        .parameters = {{"strain", "1", 0.03, -0.3, 0.3,
                        "Green's strain at which it is straight; below 0: in compression"},
                       {"remnant", "1", 0.001, 0.001, 0.5, "of the stiffness, that stays while it is slack"}},
        .strengths = {"strain"},
        .meant_ends = {"remnant"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<Slack>(p[0], p[1]);
        },
        .elastic_wall = true,
    };
}

}  // namespace cathlab
