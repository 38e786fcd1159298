// What is slack bears nothing until it is straight: of each principal (Green) strain e the part between 0 and `strain`
// is taken away before the elastic law sees it [fung1993],
//     e_elastic = e - clamp(e, 0, strain),
// for a wall in folds or a strip that hangs between its grips.  strain < 0: the same in compression, as of a specimen
// that its platens do not touch yet.  `remnant` of the wall's stiffness stays within the slack: what it takes to unfold
// it, and nothing can be solved without any.
#include <algorithm>
#include <cmath>

#include "effects/effect.h"

namespace cathlab {
namespace {

class Slack final : public Effect {
public:
    Slack(double strain, double remnant) : strain_(strain), remnant_(remnant) {}

    void strain(const EffectContext& /*context*/, MembranePoint& point) override {
        if (strain_ == 0.0) return;
        const double xx = 0.5 * (point.c[0] - 1.0), yy = 0.5 * (point.c[1] - 1.0), xy = 0.5 * point.c[2];
        const double middle = 0.5 * (xx + yy), half = 0.5 * (xx - yy);
        const double radius = std::sqrt(half * half + xy * xy);
        const double first = taken(middle + radius), second = taken(middle - radius);
        // first n n^T + second (1 - n n^T), n along the larger principal strain.
        const double cosine = radius > 0.0 ? half / radius : 1.0, sine = radius > 0.0 ? xy / radius : 0.0;
        const double mean = first + second, apart = first - second;
        point.c -= Vec3(mean + apart * cosine, mean - apart * cosine, apart * sine);
    }

private:
    double taken(double e) const {
        return (1.0 - remnant_) * std::clamp(e, std::min(0.0, strain_), std::max(0.0, strain_));
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
