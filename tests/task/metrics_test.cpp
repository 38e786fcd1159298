#include "task/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "core/check.h"

using namespace cathlab;

namespace {
constexpr double dt = 0.02;
}

TEST(ContactEvents, CountsARiseOnceUntilTheForceHasFallenAndStayedAway) {
    ContactEvents events;
    const auto hold = [&](double force, int steps) {
        for (int i = 0; i < steps; ++i) events.add(force, dt);
    };
    hold(0.0, 10);
    hold(0.015, 10);  // between the thresholds from below: no event
    EXPECT_EQ(events.count(), 0);
    hold(0.5, 10);
    hold(0.015, 10);  // between the thresholds from above: the same event
    hold(0.8, 10);
    EXPECT_EQ(events.count(), 1);
    hold(0.0, 5);  // 0.1 s: within the refractory time
    hold(0.3, 5);
    EXPECT_EQ(events.count(), 1);
    hold(0.0, 20);
    hold(0.4, 5);
    EXPECT_EQ(events.count(), 2);
    EXPECT_NEAR(events.peak_sum_n(), 0.8 + 0.4, 1e-12);
    EXPECT_NEAR(events.impulse_ns(), dt * (10 * 0.5 + 10 * 0.015 + 10 * 0.8 + 5 * 0.3 + 5 * 0.4), 1e-12);
}

TEST(Metrics, AStraightPushIsItsOwnPathAndTime) {
    MetricsAccumulator metrics;
    Channels c;
    const int wait = 50, move = 200, rest = 100;
    for (int i = 0; i < wait + move + rest; ++i) {
        if (i >= wait && i < wait + move) {
            c.wire_insertion_mm += 10.0 * dt;
            c.wire_tip_z_mm = c.wire_insertion_mm;
        }
        metrics.add(c, dt);
    }
    const Metrics m = metrics.result();
    EXPECT_NEAR(m.duration_s, 7.0, 1e-9);
    EXPECT_NEAR(m.play_time_s, 6.0, 1e-9);
    EXPECT_NEAR(m.idle_time_s, 2.0, 1e-9);
    EXPECT_NEAR(m.wire_path_mm, 40.0, 1e-9);
    EXPECT_EQ(m.catheter_path_mm, 0.0);
    EXPECT_EQ(m.wire_reversals, 0.0);
    EXPECT_LT(m.wire_sparc, 0.0);
    EXPECT_EQ(m.catheter_sparc, 0.0);
}

TEST(Metrics, ForceFiguresOfARampAreThoseOfARamp) {
    MetricsAccumulator metrics;
    Channels c;
    for (int i = 0; i < 100; ++i) metrics.add(c, dt);  // no contact at all
    for (int i = 1; i <= 100; ++i) {
        c.wire_force_mn = 6.0 * i;
        c.catheter_force_mn = 4.0 * i;
        c.force_bar_n = 0.01 * i;
        c.force_bar = c.force_bar_n / 0.8;
        metrics.add(c, dt);
    }
    const Metrics m = metrics.result();
    EXPECT_NEAR(m.force_max_n, 1.0, 1e-12);
    EXPECT_NEAR(m.force_mean_n, 0.505 / 2.0, 1e-12);
    EXPECT_NEAR(m.force_mean_in_contact_n, 0.505, 1e-12);
    EXPECT_NEAR(m.force_p95_n, 0.9505, 1e-12);  // place 0.95 * 99 = 94.05 in 0.01 .. 1.00
    EXPECT_NEAR(m.force_impulse_ns, 0.505 * 2.0, 1e-12);
    EXPECT_NEAR(m.time_above_limit_s, 20 * dt, 1e-12);
    EXPECT_NEAR(m.force_bar_max, 1.25, 1e-12);
    EXPECT_EQ(m.contacts, 1.0);
    EXPECT_NEAR(m.accumulated_collision_n, 1.0, 1e-12);
}

TEST(Metrics, ReversalsNeedAMillimetreAndRotationsAddUp) {
    MetricsAccumulator metrics;
    Channels c;
    const auto go = [&](double mm, double deg, int steps) {
        for (int i = 0; i < steps; ++i) {
            c.catheter_insertion_mm += mm / steps;
            c.catheter_rotation_deg += deg / steps;
            metrics.add(c, dt);
        }
    };
    metrics.add(c, dt);
    go(20.0, 90.0, 50);
    go(-0.5, -30.0, 50);
    go(5.0, 0.0, 50);
    go(-10.0, 0.0, 50);
    go(3.0, 0.0, 50);
    const Metrics m = metrics.result();
    EXPECT_EQ(m.catheter_reversals, 2.0);
    EXPECT_NEAR(m.catheter_rotation_total_deg, 120.0, 1e-9);
    EXPECT_EQ(m.wire_reversals, 0.0);
}

TEST(Metrics, DoseAndContrastAreTheLastOfTheirChannels) {
    MetricsAccumulator metrics;
    Channels c;
    c.beam_time_s = 3.0;
    metrics.add(c, dt);
    c.beam_time_s = 4.5;
    c.air_kerma_mgy = 0.7;
    c.dose_area_product_gycm2 = 0.02;
    c.contrast_injected_ml = 7.1;
    metrics.add(c, dt);
    const Metrics m = metrics.result();
    EXPECT_EQ(m.fluoroscopy_time_s, 4.5);
    EXPECT_EQ(m.air_kerma_mgy, 0.7);
    EXPECT_EQ(m.dose_area_product_gycm2, 0.02);
    EXPECT_EQ(m.contrast_ml, 7.1);
}

TEST(Metrics, ARoadmapIsAnAidWhileTheBeamIsOn) {
    MetricsAccumulator sum;
    for (const auto& [beam, roadmap] : {std::pair{1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, 1.0}}) {
        Channels c{};
        c.beam_on = beam;
        c.roadmap = roadmap;
        sum.add(c, 0.5);
    }
    EXPECT_DOUBLE_EQ(sum.result().roadmap_time_s, 1.0);
}

TEST(Metrics, NothingRecordedIsAllZeroAndAChangedStepIsAMistake) {
    MetricsAccumulator metrics;
    const Metrics none = metrics.result();
    for (const MetricInfo& info : metric_table()) EXPECT_EQ(none.*(info.value), 0.0) << info.name;
    metrics.add({}, dt);
    EXPECT_THROW(metrics.add({}, 2.0 * dt), std::logic_error);
    EXPECT_EQ(find_metric("contacts")->unit, "1");
    EXPECT_EQ(find_metric("no such"), nullptr);
}

TEST(Metrics, EachStandsInTheDocumentWithItsUnit) {
    std::ifstream in(std::string(CATHLAB_SOURCE_DIR) + "/docs/metrics.md");
    const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    for (const MetricInfo& metric : metric_table()) {
        const auto name = text.find("`" + std::string(metric.name) + "`");
        ASSERT_NE(name, std::string::npos) << metric.name << " is missing in docs/metrics.md";
        const std::string row = text.substr(name, text.find('\n', name) - name);
        EXPECT_NE(row.find(std::string(metric.unit)), std::string::npos) << metric.name << ": " << row;
    }
}
