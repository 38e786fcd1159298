// Proves the hook `constraint`: every particle is tied to its rest position by a spring.
#include "effects/effect.h"

namespace cathlab {
namespace {

class TestConstraint final : public Effect {
public:
    explicit TestConstraint(double stiffness_mn_per_mm) : stiffness_mn_per_mm_(stiffness_mn_per_mm) {}
    void constraint(const EffectContext& context, std::vector<WallAnchor>& anchors) override {
        for (std::size_t i = 0; i < context.wall_rest.size(); ++i)
            if (!context.wall_fixed[i])
                anchors.push_back({static_cast<Index>(i), context.wall_rest[i], stiffness_mn_per_mm_});
    }

private:
    double stiffness_mn_per_mm_;
};

}  // namespace

EffectInfo test_constraint_effect() {
    return {
        .name = "test_constraint",
        .doc = "every particle is tied to its rest position by a spring",
        .source = "",
        .hooks = hook_constraint,
        .for_tests = true,
        .applies_to = {},
        .parameters = {{"stiffness_mn_per_mm", "mN/mm", 1.0, 0.000001, 1000.0, "strength"}},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> {
            return std::make_unique<TestConstraint>(p[0]);
        },
    };
}

}  // namespace cathlab
