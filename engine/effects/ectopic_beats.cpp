// A beat that comes early finds a heart less filled and moves it less; after the pause that follows the next one moves
// it more.  The excursion depends on how long the beat before took [seed1988]:
//     excursion x (1 + weakness (interval - 1)),   interval in usual beats, the factor never below 0.
// In the simulator one beat in `every_beats` comes early by `prematurity` of a beat and the next as much late, so that
// the rhythm goes on as if nothing had been.  Where beats were recorded their own intervals count.
#include <algorithm>
#include <cmath>

#include "effects/effect.h"

namespace cathlab {
namespace {

class EctopicBeats final : public Effect {
public:
    explicit EctopicBeats(std::span<const double> p)
        : weakness_(p[0]), prematurity_(p[1]), every_(static_cast<std::int64_t>(std::floor(p[2] + 0.5))) {}

    void drive(const EffectContext& context, Drive& drive) override {
        double interval = context.heart_interval;
        if (interval <= 0.0) {
            // Beat `every - 1` of a group is cut short, and the early one after it is followed by the pause.
            const std::int64_t place = context.heart_beats % every_;
            const double length =
                place == every_ - 1 ? 1.0 - prematurity_ : (after(context) ? 1.0 + prematurity_ : 1.0);
            drive.heart_rate_scale /= length;
            interval = after(context)
                           ? 1.0 - prematurity_
                           : (context.heart_beats > every_ && place == 1 % every_ ? 1.0 + prematurity_ : 1.0);
        }
        drive.heart_amplitude_scale *= std::max(0.0, 1.0 + weakness_ * (interval - 1.0));
    }

private:
    bool after(const EffectContext& context) const {
        return context.heart_beats > 0 && context.heart_beats % every_ == 0;
    }

    double weakness_, prematurity_;
    std::int64_t every_;
};

}  // namespace

EffectInfo ectopic_beats_effect() {
    return {
        .name = "ectopic_beats",
        .doc = "a beat that comes early moves the heart less, the one after its pause more",
        .source = "seed1988",
        .hooks = hook_drive,
        .for_tests = false,
        .applies_to = {"heart-motion"},
        .parameters = {{"weakness", "1", 1.0, -3.0, 3.0, "change of the excursion a change of the interval before"},
                       {"prematurity", "1", 0.35, 0.0, 0.6, "how early an ectopic beat comes, in beats"},
                       {"every_beats", "1", 8.0, 3.0, 1000.0, "one beat in so many is ectopic"}},
        .strengths = {"weakness", "prematurity"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<EctopicBeats>(p); },
    };
}

}  // namespace cathlab
