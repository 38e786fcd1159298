#include <algorithm>
#include <cmath>
#include <limits>

#include "explain/beat_clock.h"
#include "explain/structure.h"

namespace cathlab {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Its rate, its direction, and the way that it went since the run began.
void add_motion(const Dataset& data, const std::string& name, const std::vector<double>& values,
                std::vector<Regressor>& out) {
    Regressor rate{"rate of " + name, {}, false}, direction{"direction of " + name, {}, false},
        excursion{"last turning point of " + name, {}, false};
    double going = 0.0, turned_at = nan;
    for (std::size_t i = 0; i < data.rows(); ++i) {
        const bool first = i == 0 || data.run[i] != data.run[i - 1];
        if (first) {
            going = 0.0;
            turned_at = values[i];
        }
        const double step = first ? 0.0 : values[i] - values[i - 1];
        const double dt = first ? 1.0 : data.time_s[i] - data.time_s[i - 1];
        if (step * going < 0.0) turned_at = values[i - 1];
        if (step != 0.0) going = step > 0.0 ? 1.0 : -1.0;
        rate.values.push_back(step / dt);
        direction.values.push_back(going);
        excursion.values.push_back(turned_at);
    }
    out.push_back(std::move(rate));
    out.push_back(std::move(direction));
    out.push_back(std::move(excursion));
}

}  // namespace

std::vector<Regressor> regressors(const Dataset& data) {
    std::vector<Regressor> out;
    for (const DataColumn& column : data.columns) {
        if (column.role == ColumnRole::measured) continue;
        out.push_back({column.name, column.values, false});
        if (column.role == ColumnRole::input) add_motion(data, column.name, column.values, out);
    }
    out.push_back({"time", data.time_s, false});
    Regressor run{"run", {}, true};
    for (const Index r : data.run) run.values.push_back(static_cast<double>(r));
    if (data.run_names.size() > 1) out.push_back(std::move(run));
    const BeatClock clock(data);
    if (clock.recorded()) {
        Regressor phase{"phase of the beat", {}, false}, number{"number of the beat", {}, false},
            parity{"even and odd beats", {}, true}, interval{"interval before the beat", {}, false};
        for (std::size_t i = 0; i < data.rows(); ++i) {
            const BeatTime beat = clock.at(i);
            phase.values.push_back(beat.phase);
            number.values.push_back(static_cast<double>(beat.number));
            parity.values.push_back(static_cast<double>(beat.number % 2));
            interval.values.push_back(beat.interval);
        }
        out.push_back(std::move(phase));
        out.push_back(std::move(number));
        out.push_back(std::move(parity));
        out.push_back(std::move(interval));
    }
    // What never changes explains nothing.
    std::erase_if(out, [](const Regressor& r) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const double v : r.values)
            if (!std::isnan(v)) {
                low = std::min(low, v);
                high = std::max(high, v);
            }
        return !(high > low);
    });
    return out;
}

}  // namespace cathlab
