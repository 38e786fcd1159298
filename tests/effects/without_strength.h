// Effects as they are where there is none of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "effects/effect.h"

namespace effects_test {

/// act(info, values) for every effect that uses one of the hooks: its strengths are 0, all else is as usual.
template <class Act>
void for_each_without_strength(unsigned hooks, Act&& act) {
    for (const cathlab::EffectInfo& info : cathlab::effect_table()) {
        if ((info.hooks & hooks) == 0 || info.for_tests) continue;
        ASSERT_FALSE(info.strengths.empty()) << info.name;
        std::vector<double> values;
        for (const cathlab::Parameter& p : info.parameters) {
            const bool strength =
                std::find(info.strengths.begin(), info.strengths.end(), p.key) != info.strengths.end();
            values.push_back(strength ? 0.0 : p.default_value);
        }
        act(info, values);
    }
}

}  // namespace effects_test
