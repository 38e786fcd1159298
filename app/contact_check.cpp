#include "contact_check.h"

#include <cmath>
#include <cstdio>
#include <mutex>

#include "calibrate/contact_comparison.h"
#include "core/units.h"
#include "explain/dataset.h"
#include "explain/wall_contact.h"
#include "progress.h"
#include "session.h"

namespace cathlab {
namespace {

std::vector<MeasuredPush> pushes_of(const Dataset& data) {
    const auto column = [&](const std::string& quantity) -> const std::vector<double>& {
        return data.find(quantity)->values;  // the kind's columns are there, or the data set had not been read
    };
    const DataColumn* force = data.find("force");
    std::vector<MeasuredPush> pushes(data.run_names.size());
    for (std::size_t i = 0; i < data.rows(); ++i) {
        const auto run = static_cast<std::size_t>(data.run[i]);
        MeasuredPush& m = pushes[run];
        m.name = data.run_names[run];
        m.push.marker_mm = data.contact.sensor_rest_mm[run];
        const Vec3 tool(column("tool_x")[i], column("tool_y")[i], column("tool_z")[i]);
        const Vec3 sensor(column("sensor_x")[i], column("sensor_y")[i], column("sensor_z")[i]);
        if (!tool.allFinite() || !sensor.allFinite()) continue;  // a missing cell
        m.push.ball_mm.push_back(tool);
        m.marker_mm.push_back(sensor);
        if (force != nullptr) m.force_mn.push_back(force->values[i]);
    }
    return pushes;
}

void print(const ContactComparison& c) {
    std::printf("at full depth          marker moved, mm           force, N              largest miss\n");
    std::printf("contact            wall    data   ratio      wall    data   ratio           mm\n");
    for (const PushComparison& p : c.pushes) {
        std::printf("%-14s %8.3f%8.3f%8.3f", p.name.c_str(), p.moved_mm, p.measured_mm, p.moved_mm / p.measured_mm);
        if (p.measured_force_mn != 0.0)
            std::printf("  %8.3f%8.3f%8.3f", p.force_mn / units::newton, p.measured_force_mn / units::newton,
                        p.force_mn / p.measured_force_mn);
        else
            std::printf("  %8.3f       -       -", p.force_mn / units::newton);
        std::printf("     %8.3f\n", p.largest_miss_mm);
    }
    const Figures& f = c.displacement;
    std::printf("\ndisplacement of the marker, wall less data, over %zu samples, mm\n", c.moved_mm.size());
    std::printf("  mean +- SD       %7.3f +- %.3f\n", f.mean, f.sd);
    std::printf("  absolute +- SD   %7.3f +- %.3f\n", f.mean_absolute, f.sd_absolute);
    std::printf("  RMSE             %7.3f\n", f.rmse);
    std::printf("  median           %7.3f\n", f.median);
    std::printf("  90th percentile  %7.3f\n", f.p90);
    std::printf("  maximum          %7.3f\n", f.maximum);
    std::printf("  Pearson          %7.4f\n", c.pearson);
    std::printf("  place, RMSE      %7.3f\n", c.place_rmse_mm);
    if (std::isfinite(c.worst_force))
        std::printf("force: RMS %.1f %% of a contact's largest; worst at full depth %.1f %%\n", 100.0 * c.force_rms,
                    100.0 * c.worst_force);
}

}  // namespace

void check_contacts(const ContactCheck& options, AppContext& context) {
    const Dataset data = read_dataset(options.folder);
    if (data.kind != "wall-contact")
        throw UserError(options.folder + ": a data set of kind " + data.kind +
                        "; --contact wants one of kind wall-contact");
    const std::vector<MeasuredPush> pushes = pushes_of(data);
    catch_stop_signals();
    Progress progress("pressing the wall");
    std::mutex drawing;
    double done = 0.0;
    const auto on_sample = [&] {
        const std::scoped_lock lock(drawing);
        progress.update(done / static_cast<double>(data.rows()), std::to_string(pushes.size()) + " contacts");
        done += 1.0;
        return !stop_wanted();
    };
    try {
        const ContactComparison found = compare_contacts(push_rig_of(data.contact, options.particle_spacing_mm), pushes,
                                                         Workers(options.threads), on_sample);
        progress.end();
        print(found);
    } catch (const UserError&) {
        progress.end();
        if (!stop_wanted()) throw;
        context.exit_code = 1;
        std::fprintf(stderr, "cathlab: stopped; a part of the contacts is no comparison\n");
    }
}

}  // namespace cathlab
