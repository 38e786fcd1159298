// The manifests of channels and actions, and the frames and units beside them.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "core/channels.h"
#include "core/input.h"
#include "core/types.h"
#include "core/units.h"

using namespace cathlab;

TEST(Tables, EveryChannelHasANameAUnitAMeaningAndItsOwnPlace) {
    std::set<std::string_view> names;
    std::set<const double*> places;
    Channels channels;
    for (const ChannelInfo& c : channel_table()) {
        EXPECT_TRUE(names.insert(c.name).second) << c.name;
        EXPECT_TRUE(places.insert(&(channels.*(c.value))).second) << c.name;
        EXPECT_FALSE(c.unit.empty() || c.doc.empty()) << c.name;
        EXPECT_EQ(find_channel(c.name), &c);
    }
    EXPECT_EQ(find_channel("no_such_channel"), nullptr);
    EXPECT_EQ(sizeof(Channels), names.size() * sizeof(double));
}

TEST(Tables, AnActionsDefaultLiesWithinItsRangeAndIsTheInputsOwn) {
    const Input input;
    for (const ActionInfo& a : action_table()) {
        EXPECT_LE(a.minimum, a.default_value) << a.name;
        EXPECT_GE(a.maximum, a.default_value) << a.name;
        EXPECT_EQ(input.*(a.value), a.default_value) << a.name;
        EXPECT_EQ(find_action(a.name), &a);
    }
    EXPECT_EQ(find_action("fly"), nullptr);
}

TEST(Tables, AChannelsNameEndsInItsUnit) {
    const std::set<std::string> suffixed{"mm", "deg", "mN", "N", "s", "mGy", "mL", "kV", "uJ", "nGy"};
    for (const ChannelInfo& c : channel_table()) {
        if (!suffixed.count(std::string(c.unit))) continue;
        std::string ending = "_";
        for (const char letter : c.unit) ending += static_cast<char>(std::tolower(letter));
        if (c.unit == "kV") ending = "_kvp";
        EXPECT_TRUE(c.name.ends_with(ending)) << c.name << " is in " << c.unit;
    }
}

TEST(Frames, ToWorldAndToLocalAreInverse) {
    const double half = std::sqrt(0.5);
    const Pose pose{Vec3(1.0, 2.0, 3.0), Quat(half, 0.0, 0.0, half)};  // a quarter turn about z
    EXPECT_LT((pose.to_world(Vec3::UnitX()) - Vec3(1.0, 3.0, 3.0)).norm(), 1e-15);
    const Vec3 p(0.3, -4.0, 5.5);
    EXPECT_LT((pose.to_local(pose.to_world(p)) - p).norm(), 1e-14);
}

TEST(Units, AgreeWithTheirDefinitions) {
    EXPECT_DOUBLE_EQ(180.0 * units::deg, units::pi);
    EXPECT_DOUBLE_EQ(6.0 * units::french, 2.0);                  // 6 Fr = 2 mm
    EXPECT_NEAR(120.0 * units::mmhg, 15.9987, 1e-4);             // kPa
    EXPECT_DOUBLE_EQ(1.0 * units::gram_per_cm3 * 1000.0, 1e-3);  // a millilitre of water weighs a gram
    EXPECT_DOUBLE_EQ(0.035 * units::inch, 0.889);
    EXPECT_DOUBLE_EQ(1e-3 * units::gravity, 9.80665);  // a gram weighs 9.8 mN
}
