#include <gtest/gtest.h>

#include <set>
#include <string>

#include "effects/effect.h"

namespace cathlab {
namespace {

std::unique_ptr<Effect> with_defaults(const EffectInfo& info) {
    std::vector<double> values;
    for (const Parameter& p : info.parameters) values.push_back(p.default_value);
    return info.make(values);
}

TEST(Effects, EachHasItsOwnNameAndEveryDefaultLiesInItsRange) {
    std::set<std::string_view> names;
    for (const EffectInfo& info : effect_table()) {
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        EXPECT_EQ(find_effect(info.name), &info);
        EXPECT_NE(info.hooks, 0U) << info.name;
        EXPECT_EQ(info.source.empty(), info.for_tests) << info.name << ": true physics names its source";
        std::set<std::string_view> keys;
        for (const Parameter& p : info.parameters) {
            EXPECT_TRUE(keys.insert(p.key).second) << info.name << "." << p.key;
            EXPECT_LE(p.minimum, p.default_value) << info.name << "." << p.key;
            EXPECT_GE(p.maximum, p.default_value) << info.name << "." << p.key;
        }
    }
    EXPECT_EQ(find_effect("no such effect"), nullptr);
}

TEST(Effects, EveryHookIsProvedByATestEffect) {
    unsigned proved = 0;
    for (const EffectInfo& info : effect_table())
        if (info.for_tests) proved |= info.hooks;
    EXPECT_EQ(proved, 511U);
    EXPECT_EQ(hook_names(511U).size(), 9U);
}

struct Supports {
    std::vector<Vec3> rest{Vec3(0, 0, 50), Vec3(0, 0, -200), Vec3(0, 0, -400)};
    std::vector<std::uint8_t> fixed{1, 1, 1};
    Drive drive;

    Drive& at(Effect& effect, double time_s) {
        EffectContext context;
        context.time_s = time_s;
        context.wall_rest = rest;
        context.wall_fixed = fixed;
        drive = {};
        drive.support_displacement.assign(rest.size(), Vec3::Zero());
        effect.drive(context, drive);
        return drive;
    }
};

TEST(Respiration, IsAtRestAtEndExpirationAndFullyOutHalfABreathLater) {
    const EffectInfo& info = *find_effect("respiration");
    const auto effect = with_defaults(info);
    Supports supports;
    for (const Vec3& u : supports.at(*effect, 0.0).support_displacement) EXPECT_NEAR(u.norm(), 0.0, 1e-12);
    const Drive& out = supports.at(*effect, 2.0);                 // half of the default period of 4 s
    EXPECT_NEAR(out.support_displacement[0].norm(), 6.0, 1e-9);   // the default amplitude above the diaphragm
    EXPECT_NEAR(out.support_displacement[1].norm(), 3.0, 1e-9);   // half-way between the two heights
    EXPECT_NEAR(out.support_displacement[2].norm(), 0.0, 1e-12);  // the pelvis stands still
    EXPECT_LT(out.support_displacement[0].z(), 0.0);              // downwards
}

TEST(Respiration, LastsLongerAtExpirationThanAtInspiration) {
    const auto effect = with_defaults(*find_effect("respiration"));
    Supports supports;
    int low = 0;
    int high = 0;
    for (int i = 0; i < 400; ++i) {
        const double a = supports.at(*effect, 0.01 * i).support_displacement[0].norm();
        low += a < 1.0 ? 1 : 0;
        high += a > 5.0 ? 1 : 0;
    }
    EXPECT_GT(low, 2 * high);
}

}  // namespace
}  // namespace cathlab
