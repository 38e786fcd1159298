// The tendons of a segment run through all segments before it: they bend those too, and whatever bends those shortens
// their way [camarillo2009].  With b_i the bend of segment i (base first), c_i what its own tendons ask of it alone, K
// the stiffness of a segment in bending and k that with which its tendons hold what they ask, the bends store
//     sum_i  K/2 |b_i|^2 + k/2 |b_1 + ... + b_i - (1 + K/k) c_i|^2,
// and are the least of it: one segment alone does what it is asked.  With tendons that do not stretch (K/k -> 0) every
// tendon says where its segment's end points: b_i = c_i - c_(i-1).  `share` is the part of the bends that obeys this
// law.
#include <Eigen/Cholesky>
#include <algorithm>

#include "effects/effect.h"

namespace cathlab {
namespace {

class TendonRouting final : public Effect {
public:
    TendonRouting(double share, double give) : share_(share), give_(give) {}

    void actuation(const EffectContext& /*context*/, Actuation& act) override {
        const auto n = static_cast<Eigen::Index>(act.segments.size());
        if (n < 2 || share_ == 0.0) return;
        if (solver_.rows() != n) {
            // In units of k: give b_i + sum over m >= i of (b_1 + ... + b_m) = sum over m >= i of (1 + give) c_m.
            Eigen::MatrixXd matrix(n, n);
            for (Eigen::Index i = 0; i < n; ++i)
                for (Eigen::Index j = 0; j < n; ++j)
                    matrix(i, j) = static_cast<double>(n - std::max(i, j)) + (i == j ? give_ : 0.0);
            solver_.compute(matrix);
        }
        Eigen::MatrixXd asked(n, 2);
        Vec2 sum = Vec2::Zero();
        for (Eigen::Index i = n; i-- > 0;) {
            sum += (1.0 + give_) * act.segments[static_cast<std::size_t>(i)].bend_rad;
            asked.row(i) = sum.transpose();
        }
        const Eigen::MatrixXd bends = solver_.solve(asked);
        for (Eigen::Index i = 0; i < n; ++i) {
            Vec2& bend = act.segments[static_cast<std::size_t>(i)].bend_rad;
            bend += share_ * (Vec2(bends.row(i).transpose()) - bend);
        }
    }

private:
    double share_, give_;
    Eigen::LLT<Eigen::MatrixXd> solver_;
};

}  // namespace

EffectInfo tendon_routing_effect() {
    return {
        .name = "tendon_routing",
        .doc = "the tendons of a segment run through those before it and bend them too",
        .source = "camarillo2009",
        .hooks = hook_actuation,
        .for_tests = false,
        .applies_to = {"catheter-tip", "tendon-tip"},
        .parameters = {{"share", "1", 1.0, 0.0, 1.0, "part of the bends that obeys the law; 1 = all"},
                       {"give", "1", 0.5, 0.01, 50.0, "stiffness of a segment over that of its tendons' hold"}},
        .strengths = {"share"},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<TendonRouting>(p[0], p[1]);
        },
    };
}

}  // namespace cathlab
