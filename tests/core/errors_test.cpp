#include "core/errors.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/check.h"
#include "core/log.h"
#include "core/range.h"

using namespace cathlab;

TEST(Errors, NameTheNearestKnownWord) {
    const std::vector<std::string> known{"insertion_mm", "rotation_deg", "length_mm"};
    EXPECT_EQ(nearest_name("insertoin_mm", known), "insertion_mm");
    EXPECT_EQ(nearest_name("lenght_mm", known), "length_mm");
    EXPECT_EQ(did_you_mean("rotation", known), "; did you mean 'rotation_deg'?");
    EXPECT_EQ(nearest_name("qqqqqqqqqqqqqqqqqqqq", known), "");
    EXPECT_EQ(did_you_mean("", known), "");
    EXPECT_EQ(nearest_name(std::string(100000, 'a'), known), "");
    EXPECT_EQ(nearest_name("a", {}), "");
}

TEST(Errors, SayWhereAsFarAsItIsKnown) {
    EXPECT_STREQ(UserError({"scene.toml", 12, "wire.length_mm"}, "is -1").what(),
                 "scene.toml:12: wire.length_mm: is -1");
    EXPECT_STREQ(UserError({"scene.toml", 0, ""}, "is empty").what(), "scene.toml: is empty");
    EXPECT_TRUE(UserError("no such job", true).wrong_use());
    EXPECT_FALSE(UserError("no such file").wrong_use());
}

TEST(Errors, ANumberOutsideItsRangeIsNamedWithWhatIsAllowed) {
    const SourcePlace where{"device.toml", 7, "segments"};
    EXPECT_NO_THROW(require_range(where, "length_mm", 1.0, 1.0, 300.0));
    EXPECT_NO_THROW(require_range(where, "length_mm", 300.0, 1.0, 300.0));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {0.5, 301.0, nan, std::numeric_limits<double>::infinity()})
        EXPECT_THROW(require_range(where, "length_mm", bad, 1.0, 300.0), UserError) << bad;
    try {
        require_range(where, "length_mm", -2.5, 1.0, 300.0);
        FAIL();
    } catch (const UserError& e) {
        EXPECT_STREQ(e.what(), "device.toml:7: length_mm: found -2.5, allowed is 1 to 300");
    }
}

TEST(Errors, ListWhatIsAllowed) {
    EXPECT_EQ(comma_list({"a", "b", "c"}), "a, b, c");
    EXPECT_EQ(comma_list({}), "");
}

TEST(Errors, ADevelopersMistakeIsALogicErrorThatNamesThePlace) {
    try {
        CATHLAB_CHECK(1 == 2, "one is not two");
        FAIL();
    } catch (const std::logic_error& e) {
        const std::string text = e.what();
        EXPECT_NE(text.find("errors_test.cpp"), std::string::npos);
        EXPECT_NE(text.find("1 == 2"), std::string::npos);
        EXPECT_NE(text.find("one is not two"), std::string::npos);
    }
}

TEST(Log, RefusesAnUnknownLevelWithTheNearestKnown) {
    try {
        log::set_level("wran");
        FAIL();
    } catch (const UserError& e) {
        EXPECT_NE(std::string(e.what()).find("did you mean 'warn'"), std::string::npos);
        EXPECT_TRUE(e.wrong_use());
    }
}
