#include "step/tip_yield.h"

#include <algorithm>
#include <utility>

#include "core/units.h"

namespace cathlab {
namespace {

// The shape is that of small deflections, and contact follows a tip that is let go.
constexpr double most_of_length = 0.25;
constexpr double most_a_substep_mm = 0.3;

}  // namespace

double tip_share(const CatheterSpec& spec, double from_tip_mm) {
    const double x = std::clamp(1.0 - from_tip_mm / spec.steerable_length_mm(), 0.0, 1.0);
    return 0.5 * x * x * (3.0 - x);
}

void take_back_yield(CatheterRoute& route) {
    if (route.driven.points.empty()) return;
    route.shape = std::exchange(route.driven, {});
}

void give_yield(const CatheterSpec& spec, CatheterRoute& route) {
    if (route.yielded == Vec3::Zero()) return;
    route.driven = route.shape;
    for (std::size_t i = 0; i < route.shape.points.size(); ++i)
        route.shape.points[i] += tip_share(spec, route.shape.arc.back() - route.shape.arc[i]) * route.yielded;
    route.shape.tip.position += route.yielded;
}

TipYield tip_yield(const CatheterSpec& spec, const CatheterRoute& route) {
    TipYield tip;
    tip.compliance_mm_per_mn = route.tip_compliance_mm_per_n / units::newton;
    tip.most_mm = most_of_length * spec.steerable_length_mm();
    tip.most_change_mm = most_a_substep_mm;
    tip.start = tip.way = route.yielded;
    return tip;
}

void follow_tip(std::vector<DeviceSample>& samples, const Vec3& from, const Vec3& to) {
    for (DeviceSample& s : samples)
        if (s.kinematic) s.position += s.yields * (to - from);
}

}  // namespace cathlab
