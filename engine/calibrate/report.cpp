#include "calibrate/report.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>

#include "calibrate/stations.h"

namespace cathlab {
namespace {

constexpr double percent = 100.0;

// Three decimals of a millimetre or of a percent are as many as any measurement has; always three, so that the points
// of a column stand below each other.
std::string figure(double value) {
    if (!std::isfinite(value)) return plain_number(value);
    constexpr double half = 0.0005;
    std::array<char, 400> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), std::fabs(value) < half ? 0.0 : value,
                                   std::chars_format::fixed, 3)
                         .ptr;
    return {buffer.data(), end};
}

std::string plus_minus(double mean, double sd, double factor) {
    return figure(factor * mean) + " \xC2\xB1 " + figure(factor * sd);
}

std::vector<double> scaled(std::span<const double> values, double factor) {
    std::vector<double> out;
    for (const double v : values) out.push_back(factor * v);
    return out;
}

std::vector<double> differences(std::span<const double> simulated, std::span<const double> reference, double factor) {
    std::vector<double> out;
    for (std::size_t i = 0; i < simulated.size(); ++i) out.push_back(factor * (simulated[i] - reference[i]));
    return out;
}

Plot swarm_plot(const std::vector<double>& history, const std::string& label, double factor) {
    std::vector<double> generation(history.size());
    std::iota(generation.begin(), generation.end(), 0.0);
    Plot plot{.title = "The swarm's path",
              .x_label = "generation; 0 is where it began",
              .y_label = label,
              .curves = {},
              .log_y = true};
    plot.curves.push_back({.label = "best so far",
                           .x = std::move(generation),
                           .y = scaled(history, factor),
                           .style = CurveStyle::best,
                           .marks = true});
    plot.height = 260;
    return plot;
}

PageTable swarm_table(const SwarmOptions& swarm, int runs, bool stopped) {
    return {"The swarm",
            {"", ""},
            {{"particles", std::to_string(swarm.particles)},
             {"generations", std::to_string(swarm.generations) + (stopped ? ", stopped before the end" : "")},
             {"inertia w", plain_number(swarm.omega)},
             {"own best c1", plain_number(swarm.eta1)},
             {"swarm's best c2", plain_number(swarm.eta2)},
             {"largest step, part of a range", plain_number(swarm.max_speed)},
             {"seed", std::to_string(swarm.seed)},
             {"simulations in all", std::to_string(runs)}}};
}

std::string stress_text(const WallRig& rig) {
    if (!rig.round())
        return rig.stress == RigStress::hoop
                   ? "The stress is the true one, on the section under load (constant volume)."
                   : "The stress is the force over the section at rest.";
    switch (rig.stress) {
        case RigStress::hoop:
            return "The stress is the true one in the wall, on its section under load: a pressure p = sigma t / r "
                   "pushes, with the radius and the thickness under load (thin wall of constant volume).";
        case RigStress::nominal:
            return "The stress is the force in the wall over its section at rest: F / A = sigma t0 / r0 pushes.";
        case RigStress::paper: break;
    }
    return "The stress is a radial traction, sigma = F / A as it stands: the wall itself carries r0 / t0 times as "
           "much.";
}

std::string rig_text(const WallRig& rig) {
    const auto mm = [](double value) { return plain_number(value) + " mm"; };
    switch (rig.kind) {
        case RigKind::tube:
            return "a tube of radius " + mm(rig.shape.radius_mm) + ", length " + mm(rig.shape.length_mm) +
                   " and thickness " + mm(rig.thickness_mm) +
                   ", held at both ends; strain (r - r0) / r0 of its middle third.";
        case RigKind::ring:
            return "a ring of radius " + mm(rig.shape.radius_mm) + ", width " + mm(rig.shape.length_mm) +
                   " and thickness " + mm(rig.thickness_mm) + ", its ends free; strain (r - r0) / r0.";
        case RigKind::strip:
            return "a strip " + mm(rig.length_mm) + " long, " + mm(rig.width_mm) + " wide and " + mm(rig.thickness_mm) +
                   " thick, held at one end and pulled at the other; strain along the pull of "
                   "its middle third.";
        case RigKind::block:
            return "a block " + mm(rig.length_mm) + " long, " + mm(rig.width_mm) + " wide and " + mm(rig.thickness_mm) +
                   " thick, which smooth plates and guides keep flat and even; strain along "
                   "the load.";
        case RigKind::stations: break;
    }
    return std::to_string(rig.stations->stations.size()) + " stations of the anatomy '" + rig.stations->anatomy +
           "'; at each the wall is pushed away from the centre-line over two and a half radii of the lumen to either "
           "side, and "
           "the "
           "strain (r - r0) / r0 is read half a radius to either side.";
}

PageTable station_table(const WallRig& rig, const WallCalibration& found) {
    PageTable out{"Stations, % strain", {"", "region", "radius, mm", "RMSE first guess", "RMSE", "maximum"}, {}};
    for (std::size_t g = 0; g < found.gauges.size(); ++g) {
        const Station& station = rig.stations->stations[g];
        const GaugeCurve& gauge = found.gauges[g];
        out.rows.push_back({gauge.name, station.region, plain_number(station.radius_mm),
                            figure(percent * gauge.figures_first.rmse), figure(percent * gauge.figures.rmse),
                            figure(percent * gauge.figures.maximum)});
    }
    return out;
}

PageTable strain_table(const StressStrain& reference, const WallCalibration& found) {
    constexpr std::size_t most_rows = 30;
    PageTable out{"Strain at the stations, %", {"stress, kPa", "reference"}, {}};
    for (const GaugeCurve& gauge : found.gauges) out.header.push_back(gauge.name);
    const std::size_t n = reference.strain.size(), rows = std::min(n, most_rows);
    for (std::size_t k = 0; k < rows; ++k) {
        const std::size_t i = rows == 1 ? 0 : k * (n - 1) / (rows - 1);
        std::vector<std::string>& row = out.rows.emplace_back();
        row.push_back(plain_number(reference.stress_kpa[i]));
        row.push_back(figure(percent * reference.strain[i]));
        for (const GaugeCurve& gauge : found.gauges) row.push_back(figure(percent * gauge.strain[i]));
    }
    return out;
}

}  // namespace

PageTable figure_table(const Figures& first, const Figures& best, const std::string& unit, double factor) {
    const auto row = [&](const std::string& name, double a, double b) {
        return std::vector<std::string>{name, figure(factor * a), figure(factor * b)};
    };
    PageTable out{"Error, " + unit, {"", "first guess", "best"}, {}};
    out.rows.push_back(row("RMSE", first.rmse, best.rmse));
    out.rows.push_back(
        {"mean \xC2\xB1 SD", plus_minus(first.mean, first.sd, factor), plus_minus(best.mean, best.sd, factor)});
    out.rows.push_back({"mean absolute \xC2\xB1 SD", plus_minus(first.mean_absolute, first.sd_absolute, factor),
                        plus_minus(best.mean_absolute, best.sd_absolute, factor)});
    out.rows.push_back(row("median absolute", first.median, best.median));
    out.rows.push_back(row("90th percentile absolute", first.p90, best.p90));
    out.rows.push_back(row("maximum absolute", first.maximum, best.maximum));
    return out;
}

Page wall_page(const StressStrain& reference, const WallSearch& search, const WallCalibration& found,
               const std::string& command) {
    Page page;
    page.title = "Calibration of the wall";
    page.paragraphs.push_back("Reference: " + reference.file + ", " + std::to_string(reference.strain.size()) +
                              " rows. Rig: " + rig_text(search.rig) + " " + stress_text(search.rig));
    if (found.stopped) page.paragraphs.emplace_back("The search was stopped; this is the best that it had found.");
    page.tables.push_back(figure_table(found.figures_first, found.figures, "% strain", percent));
    PageTable searched{"What was searched", {"", "from", "to", "first guess", "best"}, {}};
    for (std::size_t k = 0; k < found.values.size(); ++k)
        searched.rows.push_back({found.values[k].first, plain_number(found.free[k].lower),
                                 plain_number(found.free[k].upper), plain_number(found.first[k].second),
                                 plain_number(found.values[k].second, 5)});
    page.tables.push_back(searched);

    if (search.rig.kind == RigKind::stations) {
        page.tables.push_back(station_table(search.rig, found));
        page.details.push_back(strain_table(reference, found));
    }
    for (const GaugeCurve& gauge : found.gauges) {
        const std::string where = found.gauges.size() > 1 ? ", " + gauge.name : "";
        Plot curve{
            .title = "Strain over stress" + where, .x_label = "stress, kPa", .y_label = "strain, %", .curves = {}};
        const auto add = [&](Plot& plot, const char* label, std::vector<double> y, CurveStyle style, bool line) {
            plot.curves.push_back({.label = label,
                                   .x = reference.stress_kpa,
                                   .y = std::move(y),
                                   .style = style,
                                   .marks = !line,
                                   .line = line});
        };
        add(curve, "reference", scaled(reference.strain, percent), CurveStyle::reference, false);
        add(curve, "first guess", scaled(gauge.strain_first, percent), CurveStyle::first, true);
        add(curve, "best", scaled(gauge.strain, percent), CurveStyle::best, true);
        Plot error{.title = "Error over stress" + where,
                   .x_label = "stress, kPa",
                   .y_label = "simulated - reference, % strain",
                   .curves = {},
                   .zero_line = true};
        add(error, "first guess", differences(gauge.strain_first, reference.strain, percent), CurveStyle::first, true);
        add(error, "best", differences(gauge.strain, reference.strain, percent), CurveStyle::best, true);
        error.height = 300;
        page.plots.push_back(std::move(curve));
        page.plots.push_back(std::move(error));
    }
    page.plots.push_back(swarm_plot(found.best_history, "RMSE, % strain", percent));
    PageTable swarm = swarm_table(search.swarm, found.evaluations, found.stopped);
    swarm.rows.insert(swarm.rows.end() - 1,
                      {"local search after it, simulations at most", std::to_string(search.polish_evaluations)});
    page.details.push_back(std::move(swarm));
    page.command = command;
    return page;
}

Page heart_page(const HeartSearch& search, const HeartCalibration& found, const std::string& reference,
                const std::string& command) {
    constexpr double mm = 1.0;
    std::string in_beats = "time, beats";
    if (!found.motion.beat.empty()) {
        const double begin = found.motion.phase.front() - found.motion.beat.front();
        in_beats += " from phase " + plain_number(begin - std::floor(begin), 3);
    }
    Page page;
    page.title = "Calibration of the heart";
    page.paragraphs.push_back(
        "Reference: " + reference + ". The annulus' mean displacement along its axis into the aorta, over " +
        std::to_string(search.beats) + " beats at " + plain_number(search.scene.heart.rate_bpm) +
        " a minute after one that does not count. The rest pose of the vessels is the moment at which the annulus "
        "stands nearest to the apex: phase " +
        plain_number(search.target.rest_phase, 3) + " of the reference, where its displacement counts as 0.");
    page.paragraphs.push_back(
        std::string("Objective: ") +
        (search.at_peaks ? "the error at the peaks of each beat, and a tenth of the RMSE." : "the RMSE.") +
        " The search begins at the inverse (three or so runs, RMSE " + plain_number(found.figures_start.rmse, 3) +
        " mm); from there the swarm looked " + plain_number(found.reach_mm, 2) + " mm to either side of each knot.");
    if (found.stopped) page.paragraphs.emplace_back("The search was stopped; this is the best that it had found.");
    page.tables.push_back(figure_table(found.figures_first, found.figures, "mm", mm));

    Plot curve{.title = "Annulus over the beats",
               .x_label = in_beats,
               .y_label = "displacement into the aorta, mm",
               .curves = {}};
    curve.curves = {
        {.label = "reference", .x = found.motion.beat, .y = found.reference, .style = CurveStyle::reference},
        {.label = "first guess", .x = found.first.beat, .y = found.first.z_mm, .style = CurveStyle::first},
        {.label = "best",
         .x = found.motion.beat,
         .y = found.motion.z_mm,
         .style = CurveStyle::best,
         .marks = true,
         .line = false}};
    Plot error{.title = "Error over the beats",
               .x_label = in_beats,
               .y_label = "simulated - reference, mm",
               .curves = {},
               .zero_line = true};
    error.curves = {{.label = "first guess",
                     .x = found.first.beat,
                     .y = differences(found.first.z_mm, found.reference_first, mm),
                     .style = CurveStyle::first},
                    {.label = "best",
                     .x = found.motion.beat,
                     .y = differences(found.motion.z_mm, found.reference, mm),
                     .style = CurveStyle::best}};
    error.height = 300;
    page.plots = {curve, error, swarm_plot(found.best_history, search.at_peaks ? "objective, mm" : "RMSE, mm", mm)};
    Plot profile{.title = "The cylinder's profile",
                 .x_label = "phase of the beat",
                 .y_label = "displacement up, mm",
                 .curves = {}};
    profile.curves.push_back(
        {.label = "best, at its knots", .x = {}, .y = {}, .style = CurveStyle::best, .marks = true, .line = false});
    for (const auto& [phase, displacement] : found.profile) {
        profile.curves[0].x.push_back(phase);
        profile.curves[0].y.push_back(displacement);
    }
    if (!found.profile.empty()) {  // and begins again
        profile.curves[0].x.push_back(found.profile.front()[0] + 1.0);
        profile.curves[0].y.push_back(found.profile.front()[1]);
    }
    profile.height = 260;
    page.plots.push_back(std::move(profile));
    PageTable knots{"The cylinder's profile", {"phase", "displacement, mm"}, {}};
    for (const auto& [phase, displacement] : found.profile)
        knots.rows.push_back({plain_number(phase), plain_number(displacement, 5)});
    page.details.push_back(knots);
    page.details.push_back(swarm_table(search.swarm, found.simulations, found.stopped));
    page.command = command;
    return page;
}

}  // namespace cathlab
