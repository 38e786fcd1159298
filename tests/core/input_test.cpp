// What a step takes of a command.
#include "core/input.h"

#include <gtest/gtest.h>

#include <limits>

namespace cathlab {
namespace {

TEST(InRange, TakesTheLimitForWhatIsBeyondItAndTheDefaultForWhatIsNoNumber) {
    for (const ActionInfo& action : action_table()) {
        Input high, low, none;
        high.*action.value = 1e9;
        low.*action.value = -std::numeric_limits<double>::infinity();
        none.*action.value = std::numeric_limits<double>::quiet_NaN();
        EXPECT_EQ(in_range(high).*action.value, action.maximum) << action.name;
        EXPECT_EQ(in_range(low).*action.value, action.default_value) << action.name << ": infinity is no number";
        EXPECT_EQ(in_range(none).*action.value, action.default_value) << action.name;
    }
    const Input usual;
    for (const ActionInfo& action : action_table()) EXPECT_EQ(in_range(usual).*action.value, usual.*action.value);
}

}  // namespace
}  // namespace cathlab
