#include "rod/coaxial.h"

#include <algorithm>

#include "core/deterministic_math.h"

namespace cathlab {
namespace {

constexpr double least_share = 0.35;  // of a wire's link that makes a link of its own

// Compliances, mass and shape of a stretch, added up piece by piece.
struct Stretch {
    double bend = 0.0, twist = 0.0, axial = 0.0, mass = 0.0, curvature = 0.0, side = 0.0;

    void add(double ds, const WireLink* sleeve, const WireLink* wire, double cos_turn, double sin_turn) {
        const double bend_s = sleeve ? sleeve->bend : 0.0, bend_w = wire ? wire->bend : 0.0;
        bend += ds / (bend_s + bend_w);
        twist += ds / ((sleeve ? sleeve->twist : 0.0) + (wire ? wire->twist : 0.0));
        axial += ds / ((sleeve ? sleeve->axial : 0.0) + (wire ? wire->axial : 0.0));
        mass += ds * ((sleeve ? sleeve->mass / sleeve->length : 0.0) + (wire ? wire->mass / wire->length : 0.0));
        const double own = wire ? bend_w * wire->curvature : 0.0;
        curvature += ds * ((sleeve ? bend_s * sleeve->curvature : 0.0) + cos_turn * own) / (bend_s + bend_w);
        side += ds * (sin_turn * own) / (bend_s + bend_w);
    }

    WireLink link(const WireLink& outer, double start, double length) const {
        WireLink out = outer;  // radius and section
        out.start = start;
        out.length = length;
        out.bend = length / bend;
        out.twist = length / twist;
        out.axial = length / axial;
        out.mass = mass;
        out.inertia_along = 0.5 * mass * outer.radius * outer.radius;
        out.inertia_across = mass * (3.0 * outer.radius * outer.radius + length * length) / 12.0;
        out.curvature = curvature / length;
        out.curvature_side = side / length;
        return out;
    }
};

}  // namespace

Coaxial compose(std::span<const WireLink> wire, std::span<const WireLink> sleeve, double wire_insertion,
                double sleeve_insertion, double turn) {
    Coaxial out;
    const double ahead = wire_insertion - sleeve_insertion;  // of the wire's tip
    while (out.front < wire.size() && ahead - wire[out.front].start >= least_share * wire[out.front].length)
        ++out.front;
    // Front: the wire's own cuts, the last one up to the catheter's tip.
    for (std::size_t i = 0; i < out.front; ++i) {
        const double end = i + 1 < out.front ? wire[i].end() : ahead;
        Stretch stretch;
        for (std::size_t k = i; k < wire.size() && wire[k].start < end; ++k)
            stretch.add(std::min(end, wire[k].end()) - wire[k].start, nullptr, &wire[k], 1.0, 0.0);
        out.links.push_back(stretch.link(wire[i], wire[i].start, end - wire[i].start));
    }
    if (out.front > 0) out.ahead_mm = ahead;
    // Behind: the catheter's links, cut where the core's material changes.
    const double cos_turn = det::cos(turn), sin_turn = det::sin(turn);
    std::size_t core = 0;
    for (const WireLink& link : sleeve) {
        Stretch stretch;
        double at = link.start;
        while (at < link.end()) {
            while (core < wire.size() && wire[core].end() - ahead <= at) ++core;
            double to = link.end();
            const WireLink* inside = nullptr;
            if (core < wire.size()) {
                const bool begun = wire[core].start - ahead <= at;
                to = std::min(to, (begun ? wire[core].end() : wire[core].start) - ahead);
                if (begun) inside = &wire[core];
            }
            stretch.add(to - at, &link, inside, cos_turn, sin_turn);
            at = to;
        }
        out.links.push_back(stretch.link(link, out.ahead_mm + link.start, link.length));
    }
    return out;
}

}  // namespace cathlab
