// Proves the hook `drive`: all supports stand displaced along z.
#include "effects/effect.h"

namespace cathlab {
namespace {

class TestDrive final : public Effect {
public:
    explicit TestDrive(double offset_mm) : offset_mm_(offset_mm) {}
    void drive(const EffectContext& /*context*/, Drive& drive) override {
        for (Vec3& u : drive.support_displacement) u.z() += offset_mm_;
    }

private:
    double offset_mm_;
};

}  // namespace

EffectInfo test_drive_effect() {
    return {
        .name = "test_drive",
        .doc = "all supports stand displaced along z",
        .source = "",
        .hooks = hook_drive,
        .for_tests = true,
        .applies_to = {},
        .parameters = {{"offset_mm", "mm", 1.0, -20.0, 20.0, "strength"}},
        .make = [](std::span<const double> p) -> std::unique_ptr<Effect> { return std::make_unique<TestDrive>(p[0]); },
    };
}

}  // namespace cathlab
