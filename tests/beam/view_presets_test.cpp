#include "beam/view_presets.h"

#include <gtest/gtest.h>

#include <set>

#include "beam/c_arm.h"

using namespace cathlab;

TEST(Views, HaveNamesOfTheirOwnAndAnglesThatAMachineReaches) {
    std::set<std::string_view> names;
    for (const ViewPreset& view : view_presets()) {
        EXPECT_TRUE(names.insert(view.name).second) << view.name;
        EXPECT_EQ(find_view(view.name), &view);
        EXPECT_LE(std::abs(view.primary_deg), 90.0) << view.name;
        EXPECT_LE(std::abs(view.secondary_deg), 45.0) << view.name;
        EXPECT_FALSE(view.shows.empty());
    }
    EXPECT_EQ(find_view("spyder"), nullptr);
    EXPECT_EQ(view_names().size(), names.size());
}

TEST(Views, TheSpiderIsSeenFromTheLeftAndFromBelow) {
    const ViewPreset& spider = *find_view("spider");
    const CArmPose pose = c_arm_pose({}, Vec3::Zero(), spider.primary_deg, spider.secondary_deg);
    EXPECT_GT(pose.detector.x(), 0.0);  // LAO: at the patient's left
    EXPECT_LT(pose.detector.y(), 0.0);  // before the chest
    EXPECT_LT(pose.detector.z(), 0.0);  // caudal
    const ViewPreset& cranial = *find_view("rao_cranial");
    const CArmPose other = c_arm_pose({}, Vec3::Zero(), cranial.primary_deg, cranial.secondary_deg);
    EXPECT_LT(other.detector.x(), 0.0);
    EXPECT_GT(other.detector.z(), 0.0);
}

TEST(Views, OneComesAfterAnotherUntilTheFirstAgain) {
    const ViewPreset* view = &view_after(12.5, 3.0);  // no name
    EXPECT_EQ(view, &view_presets().front());
    for (std::size_t i = 1; i < view_presets().size(); ++i) {
        EXPECT_EQ(view_at(view->primary_deg + 0.2, view->secondary_deg), view);
        view = &view_after(view->primary_deg, view->secondary_deg);
        EXPECT_EQ(view, &view_presets()[i]);
    }
    EXPECT_EQ(&view_after(view->primary_deg, view->secondary_deg), &view_presets().front());
    EXPECT_EQ(view_at(12.5, 3.0), nullptr);
}
