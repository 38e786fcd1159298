// Drive and cables take time: each axis follows its command with a first-order lag [ljung1999],
//     tau dq/dt = command - q,
// solved exactly for commands that run straight from call to call.
#include "core/deterministic_math.h"
#include "effects/play.h"

namespace cathlab {
namespace {

class ActuationLag final : public Effect {
public:
    explicit ActuationLag(std::span<const double> p) : bend_(p[0]), rotation_(p[1]), insertion_(p[2]) {}

    void actuation(const EffectContext& context, Actuation& act) override {
        if (!started_) {
            started_ = true;
            insertion_now_ = {act.insertion_mm, act.insertion_mm};
            rotation_now_ = {act.rotation_rad, act.rotation_rad};
            for (const ActuatedSegment& s : act.segments) bends_.push_back({s.bend_rad, s.bend_rad});
        }
        follow(insertion_, context.dt, insertion_now_, act.insertion_mm);
        follow(rotation_, context.dt, rotation_now_, act.rotation_rad);
        for (std::size_t i = 0; i < bends_.size(); ++i) follow(bend_, context.dt, bends_[i], act.segments[i].bend_rad);
    }

    void visit(Archive& archive) override {
        archive.field("insertion_mm", insertion_now_.at);
        archive.field("rotation_rad", rotation_now_.at);
        for (Lagged<Vec2>& bend : bends_) {
            archive.field("bend_x_rad", bend.at.x());
            archive.field("bend_y_rad", bend.at.y());
        }
    }

private:
    template <class T>
    struct Lagged {
        T at, command;
    };
    template <class T>
    static void follow(double tau_s, double dt, Lagged<T>& axis, T& command) {
        const T wanted = command;
        if (tau_s > 0.0) {
            const double x = dt / tau_s;
            axis.at = relaxed<T>(axis.at, axis.command, wanted, x, det::exp(-x));
            command = axis.at;
        } else {
            axis.at = wanted;
        }
        axis.command = wanted;
    }

    double bend_, rotation_, insertion_;
    bool started_ = false;
    Lagged<double> insertion_now_{0.0, 0.0}, rotation_now_{0.0, 0.0};
    std::vector<Lagged<Vec2>> bends_;
};

}  // namespace

EffectInfo actuation_lag_effect() {
    return {
        .name = "actuation_lag",
        .doc = "each axis of the catheter follows its command with a first-order lag",
        .source = "ljung1999",
        .hooks = hook_actuation,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip"},
        .parameters = {{"bend_tau_s", "s", 0.3, 0.0, 10.0, "time constant of every bend"},
                       {"rotation_tau_s", "s", 0.0, 0.0, 10.0, "time constant of the rotation"},
                       {"insertion_tau_s", "s", 0.0, 0.0, 10.0, "time constant of the insertion"}},
        .strengths = {"bend_tau_s", "rotation_tau_s", "insertion_tau_s"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<ActuationLag>(p); },
    };
}

}  // namespace cathlab
