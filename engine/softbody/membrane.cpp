#include "softbody/membrane.h"

#include <algorithm>
#include <cmath>

namespace cathlab {

void ask_elastic_law(const MembraneMaterial& material, const Fibres& fibres, MembranePoint& point) {
    constexpr double least_det = 1e-12;
    const Vec3& c = point.c;
    const double d = std::max(c[0] * c[1] - c[2] * c[2], least_det);
    point.mu_kpa = material.mu_kpa;
    const double thinner = det::pow(d, -material.thinning);
    point.stress = material.mu_kpa * Vec3(1.0 - thinner * c[1] / d, 1.0 - thinner * c[0] / d, thinner * c[2] / d);
    const double thinned = material.thinning > 0.0 ? (thinner - 1.0) / material.thinning : -det::log(d);
    point.energy_kpa = 0.5 * material.mu_kpa * (c[0] + c[1] - 2.0 + thinned);
    if (material.hooke > 0.0) {
        // The root of C: U = (C + r 1) / sqrt(tr C + 2 r), r = sqrt(det C).
        const double r = std::sqrt(d), root = std::sqrt(c[0] + c[1] + 2.0 * r);
        const Vec3 u((c[0] + r) / root, (c[1] + r) / root, c[2] / root);
        const double nu = material.thinning / (1.0 + material.thinning);
        const double young = 2.0 * material.mu_kpa * (1.0 + nu), plane = young / (1.0 - nu * nu);
        const double trace = u[0] + u[1] - 2.0;
        const Vec3 t = plane * Vec3((1.0 - nu) * (u[0] - 1.0) + nu * trace, (1.0 - nu) * (u[1] - 1.0) + nu * trace,
                                    (1.0 - nu) * u[2]);
        const Vec3 s(u[1] * t[0] - u[2] * t[2], u[0] * t[1] - u[2] * t[2], u[1] * t[2] - u[2] * t[1]);
        const double stored = 0.5 * ((u[0] - 1.0) * t[0] + (u[1] - 1.0) * t[1] + 2.0 * u[2] * t[2]);
        point.stress += material.hooke * (s / r - point.stress);
        point.energy_kpa += material.hooke * (stored - point.energy_kpa);
    }
    if (!fibres.any()) return;
    const double cosine = fibres.cosine(), sine = fibres.sine();
    for (const double side : {sine, -sine}) {
        const double along = material.round.x() * cosine - material.round.y() * side,
                     across = material.round.y() * cosine + material.round.x() * side;
        const Vec3 h(0.5 + along, 0.5 - along, across);
        const double e = h[0] * c[0] + h[1] * c[1] + 2.0 * h[2] * c[2] - 1.0 - fibres.onset;
        point.stress += 2.0 * fibre_tension(fibres, e).tension * h;
        point.energy_kpa += fibre_energy(fibres, e);
    }
}

}  // namespace cathlab
