#include "contact/penetration.h"

#include <limits>
#include <vector>

#include "contact/closest_point.h"

namespace cathlab {

PenetrationReport penetration_report(const LumenSurfaceModel& model, const LumenSurfaceState& state,
                                     std::span<const DeviceSample> samples, const Workers& workers) {
    std::vector<double> distance(samples.size());
    workers.for_ranges(samples.size(), 32, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            distance[i] =
                closest(model, state, samples[i].position, std::numeric_limits<double>::infinity()).signed_distance;
        }
    });
    PenetrationReport report;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double depth = samples[i].radius - distance[i];
        if (depth > report.deepest_mm) {
            report.deepest_mm = depth;
            report.deepest_sample = static_cast<Index>(i);
        }
        if (i == 0 || distance[i] < report.least_clearance_mm) report.least_clearance_mm = distance[i];
        if (distance[i] < -samples[i].radius) ++report.outside;
    }
    return report;
}

}  // namespace cathlab
