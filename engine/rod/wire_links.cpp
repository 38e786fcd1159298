#include "rod/wire_links.h"

#include <algorithm>
#include <cmath>

#include "core/deterministic_math.h"
#include "core/units.h"

namespace cathlab {
namespace {

constexpr double least_free_share = 0.01;

WireLink make_link(const WireSection& section, Index index, double start, double length) {
    WireLink link;
    link.start = start;
    link.length = length;
    link.radius = 0.5 * section.diameter_mm;
    const double area = units::pi * link.radius * link.radius;
    link.mass = section.density_kg_m3 * 1e-9 * area * length;
    link.inertia_along = 0.5 * link.mass * link.radius * link.radius;
    link.inertia_across = link.mass * (3.0 * link.radius * link.radius + length * length) / 12.0;
    link.bend = section.bending_stiffness_n_mm2 * units::newton;
    link.twist = section.torsion_stiffness_n_mm2 * units::newton;
    link.axial = section.axial_stiffness_n * units::newton;
    link.curvature = section.rest_curvature_per_mm;
    link.section = index;
    return link;
}

}  // namespace

std::vector<WireLink> cut_into_links(const WireSpec& spec) {
    std::vector<WireLink> links;
    double start = 0.0;
    for (std::size_t i = 0; i < spec.sections.size(); ++i) {
        const WireSection& section = spec.sections[i];
        const bool last = i + 1 == spec.sections.size();
        const double length = last ? spec.length_mm - start : section.length_mm;
        const double longest = section.link_length_mm > 0.0 ? section.link_length_mm : spec.link_length_mm;
        const double count = std::max(1.0, std::ceil(length / longest - 1e-9));
        for (int k = 0; k < count; ++k)
            links.push_back(make_link(section, static_cast<Index>(i), start + length * k / count, length / count));
        start += length;
    }
    return links;
}

JointStiffness joint_stiffness(const WireLink& a, const WireLink& b, double insertion, double turn) {
    const double half_a = 0.5 * a.length, half_b = 0.5 * b.length;
    double free_a = std::clamp(insertion - a.centre(), 0.0, half_a);
    double free_b = std::clamp(insertion - b.start, 0.0, half_b);
    JointStiffness joint;
    joint.span = free_a + free_b;
    // b's share of the bend, seen in a's frame.
    double bx = b.curvature, by = b.curvature_side;
    if (turn != 0.0) {
        const double c = det::cos(turn), s = det::sin(turn);
        bx = c * b.curvature + s * b.curvature_side;
        by = c * b.curvature_side - s * b.curvature;
    }
    const Vec3 angle(a.curvature * free_a + bx * free_b, a.curvature_side * free_a + by * free_b, 0.0);
    joint.curved = angle.x() != 0.0 || angle.y() != 0.0 || turn != 0.0;
    if (joint.curved) joint.rest = det::rotation_from_vector(angle);
    if (turn != 0.0) joint.rest = joint.rest * Quat(det::cos(0.5 * turn), 0.0, 0.0, -det::sin(0.5 * turn));
    const double least = least_free_share * (half_a + half_b);
    if (joint.span < least) {
        free_a = least * half_a / (half_a + half_b);
        free_b = least * half_b / (half_a + half_b);
    }
    joint.axial = 1.0 / (free_a / a.axial + free_b / b.axial);
    joint.bend = 1.0 / (free_a / a.bend + free_b / b.bend);
    joint.twist = 1.0 / (free_a / a.twist + free_b / b.twist);
    return joint;
}

}  // namespace cathlab
