#include "calibrate/pressure_rig.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "core/parallel.h"
#include "softbody/solver.h"

namespace cathlab {
namespace {

constexpr double step_s = 0.004;
constexpr int iterations = 2;
constexpr double velocity_kept = 0.95;  // a step; bleeding moves no equilibrium
constexpr int steps_a_look = 25;
constexpr int most_looks = 200;
constexpr double still_mm = 1e-5;

Vec3 radial_part(const Vec3& p, const TubeShape& shape) {
    const Vec3 off = p - shape.start;
    return off - off.dot(shape.axis) * shape.axis;
}

}  // namespace

std::vector<double> pressure_strain(const PressureRig& rig, const WallParameters& wall,
                                    std::span<const double> stress_kpa) {
    for (const double s : stress_kpa)
        if (!std::isfinite(s) || s < 0.0) throw UserError("a stress must be 0 kPa or more, found " + std::to_string(s));
    const WallSample sample = tube_sample(rig.shape, rig.particle_spacing_mm, rig.thickness_mm, rig.seed);
    const auto along = [&](const Vec3& p) { return (p - rig.shape.start).dot(rig.shape.axis); };
    const double held = 0.75 * rig.particle_spacing_mm;
    const SoftBodyModel model = build_soft_body(
        sample, wall, [&](const Vec3& p) { return along(p) < held || along(p) > rig.shape.length_mm - held; });
    SoftBodyState state = rest_state(model);
    SoftBodyScratch scratch;
    const Workers workers(1);

    std::vector<double> out;
    std::vector<Vec3> load(model.size());
    for (const double stress : stress_kpa) {
        const double pressure = stress * rig.thickness_mm / rig.shape.radius_mm;
        for (std::size_t i = 0; i < model.size(); ++i) {
            const Vec3 radial = radial_part(model.rest[i], rig.shape);
            const double length = std::sqrt(radial.squaredNorm());
            const bool loaded = model.fixed[i] == 0 && length > 0.5 * rig.shape.radius_mm;  // not the caps
            load[i] = loaded ? Vec3(pressure * sample.area_mm2[i] / length * radial) : Vec3(Vec3::Zero());
        }
        bool still = false;
        for (int look = 0; look < most_looks && !still; ++look) {
            const std::vector<Vec3> before = state.x;
            for (int k = 0; k < steps_a_look; ++k) {
                predict(model, state, scratch, step_s, {}, workers);
                std::copy(load.begin(), load.end(), scratch.force.begin());
                for (int n = 0; n < iterations; ++n) {
                    solve_goals(model, state, scratch, workers);
                    apply(model, state, scratch, step_s, workers);
                }
                finish(model, state, scratch, step_s, workers);
                for (Vec3& v : state.v) v *= velocity_kept;
            }
            double moved = 0.0;
            for (std::size_t i = 0; i < before.size(); ++i)
                moved = std::max(moved, (state.x[i] - before[i]).squaredNorm());
            still = moved < still_mm * still_mm;
        }
        double sum = 0.0;
        int count = 0;
        for (std::size_t i = 0; i < model.size(); ++i) {
            if (std::fabs(along(model.rest[i]) / rig.shape.length_mm - 0.5) > 1.0 / 6.0) continue;
            sum += std::sqrt(radial_part(state.x[i], rig.shape).squaredNorm() /
                             radial_part(model.rest[i], rig.shape).squaredNorm()) -
                   1.0;
            ++count;
        }
        out.push_back(still ? sum / count : std::numeric_limits<double>::quiet_NaN());
    }
    return out;
}

}  // namespace cathlab
