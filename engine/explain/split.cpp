#include "explain/split.h"

#include <algorithm>

namespace cathlab {

Split split_rows(const Dataset& data) {
    constexpr double blocks_a_run = 30.0;
    Split out;
    const std::size_t runs = data.run_names.size();
    std::vector<double> first(runs), last(runs);
    std::vector<bool> seen(runs, false);
    for (std::size_t i = 0; i < data.rows(); ++i) {
        const auto r = static_cast<std::size_t>(data.run[i]);
        if (!seen[r]) first[r] = data.time_s[i];
        seen[r] = true;
        last[r] = data.time_s[i];
    }
    for (std::size_t i = 0; i < data.rows(); ++i) {
        const auto r = static_cast<std::size_t>(data.run[i]);
        const double length = last[r] - first[r];
        const double place = length > 0.0 ? (data.time_s[i] - first[r]) / length : 0.0;
        const auto in_run = static_cast<Index>(std::min(blocks_a_run - 1.0, place * blocks_a_run));
        const Index block = static_cast<Index>(r) * static_cast<Index>(blocks_a_run) + in_run;
        out.block.push_back(block);
        out.blocks = std::max(out.blocks, static_cast<Index>(block + 1));
        // The phase of the pattern changes from run to run, so that no part of a run is always held out.
        out.held_out.push_back((in_run + static_cast<Index>(r)) % 3 == 1 ? 1 : 0);
    }
    if (!data.held_out.empty()) out.held_out = data.held_out;
    const auto measured = data.of_role(ColumnRole::measured);
    while (out.judged < measured.size() && measured[out.judged]->unit == measured[0]->unit) ++out.judged;
    return out;
}

}  // namespace cathlab
