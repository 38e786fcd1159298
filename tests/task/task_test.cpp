#include "task/task.h"

#include <gtest/gtest.h>

#include "core/errors.h"

using namespace cathlab;

namespace {

constexpr double dt = 0.02;

TaskSpec spec() {
    TaskSpec out;
    out.name = "a";
    out.landmark = "arch_top";
    out.radius_mm = 4.0;
    out.hold_s = 2.0;
    out.time_limit_s = 10.0;
    return out;
}

Channels wire_at(double z) {
    Channels c;
    c.wire_tip_z_mm = z;
    return c;
}

}  // namespace

TEST(GoalTracker, IsReachedWhenTheTipHasBeenHeldWithoutABreak) {
    GoalTracker goal(spec());
    const Vec3 place(0.0, 0.0, 10.0);
    for (int i = 0; i < 90; ++i) goal.add(wire_at(9.0), place, dt);
    EXPECT_TRUE(goal.inside());
    goal.add(wire_at(0.0), place, dt);  // lost once, just before the end
    EXPECT_FALSE(goal.inside());
    for (int i = 0; i < 100; ++i) goal.add(wire_at(12.0), place, dt);
    EXPECT_EQ(goal.outcome(), GoalTracker::Outcome::open);
    goal.add(wire_at(12.0), place, dt);
    EXPECT_EQ(goal.outcome(), GoalTracker::Outcome::reached);
    EXPECT_NEAR(goal.completed_at_s().value(), (90 + 1 + 101) * dt, 1e-9);
    EXPECT_NEAR(goal.distance_mm(), 2.0, 1e-12);
}

TEST(GoalTracker, RunsOutOfTime) {
    GoalTracker goal(spec());
    for (int i = 0; i < 499; ++i) goal.add(wire_at(0.0), {0.0, 0.0, 10.0}, dt);
    EXPECT_EQ(goal.outcome(), GoalTracker::Outcome::open);
    goal.add(wire_at(0.0), {0.0, 0.0, 10.0}, dt);
    EXPECT_EQ(goal.outcome(), GoalTracker::Outcome::out_of_time);
    EXPECT_FALSE(goal.completed_at_s().has_value());
}

TEST(Task, WatchesTheDeviceThatItNames) {
    TaskSpec catheter = spec();
    catheter.device = "catheter";
    catheter.hold_s = 0.0;
    GoalTracker goal(catheter);
    goal.add(wire_at(10.0), {0.0, 0.0, 10.0}, dt);
    EXPECT_FALSE(goal.inside());
    Channels c;
    c.catheter_tip_z_mm = 10.0;
    goal.add(c, {0.0, 0.0, 10.0}, dt);
    EXPECT_EQ(goal.outcome(), GoalTracker::Outcome::reached);
}

TEST(Task, NamesTheNearestLandmarkDeviceAndMetric) {
    AnatomyModel anatomy;
    anatomy.name = "adult";
    anatomy.landmarks.push_back({"arch_top", {Vec3(1.0, 2.0, 3.0), Quat::Identity()}, 12.0, 0});
    TaskSpec task = spec();
    EXPECT_EQ(goal_position(task, anatomy), Vec3(1.0, 2.0, 3.0));
    const auto message = [](const auto& action) -> std::string {
        try {
            action();
        } catch (const UserError& e) {
            return e.what();
        }
        return "";
    };
    task.landmark = "arch_tap";
    EXPECT_NE(message([&] { goal_position(task, anatomy); }).find("'arch_top'"), std::string::npos);
    task.device = "cathetr";
    EXPECT_NE(message([&] { check_task(task); }).find("'catheter'"), std::string::npos);
    task.device = "wire";
    task.criteria.push_back({"play_tim_s", 60.0, 180.0, 1.0});
    EXPECT_NE(message([&] { check_task(task); }).find("'play_time_s'"), std::string::npos);
    task.criteria.clear();
    task.radius_mm = -1.0;
    EXPECT_NE(message([&] { check_task(task); }).find("radius_mm = -1"), std::string::npos);
}

TEST(Score, IsTheWeighedPartOfAHundred) {
    Metrics m;
    m.play_time_s = 120.0;
    m.accumulated_collision_n = 30.0;
    const std::vector<Criterion> criteria{{"play_time_s", 60.0, 180.0, 3.0},
                                          {"accumulated_collision_n", 0.0, 20.0, 1.0}};
    EXPECT_NEAR(score(m, criteria), 100.0 * (3.0 * 0.5 + 0.0) / 4.0, 1e-12);
    EXPECT_EQ(score(m, {}), 100.0);
}
