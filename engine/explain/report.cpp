#include "explain/report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "explain/residual.h"

namespace cathlab {
namespace {

constexpr std::size_t most_points = 1500;  // of a curve: the page stays small

std::string number(double value, int digits = 4) {
    return std::isnan(value) ? "" : plain_number(value, digits);
}

std::string unit_of(const Dataset& data) {
    const auto measured = data.of_role(ColumnRole::measured);
    return measured.empty() ? "" : measured[0]->unit;
}

PageTable error_table(const Dataset& data, const Explanation& found) {
    const std::string unit = unit_of(data).empty() ? "" : ", " + unit_of(data);
    PageTable out{"Error, root mean square a measured column" + unit, {"", "before", "after", "noise floor"}, {}};
    out.rows.push_back(
        {"rows that the fit saw", number(found.train_before), number(found.train_after), number(found.noise_floor)});
    out.rows.push_back(
        {"rows held out", number(found.held_out_before), number(found.held_out_after), number(found.noise_floor)});
    const auto measured = data.of_role(ColumnRole::measured);
    for (std::size_t c = 0; c < measured.size(); ++c)
        out.rows.push_back({measured[c]->name + ", held out", number(rms(found.before[c], found.split.held_out, 1)),
                            number(rms(found.after[c], found.split.held_out, 1)), ""});
    return out;
}

PageTable effect_table_of(const Explanation& found) {
    const auto told = [](const FittedEffect& effect, const NamedNumbers& numbers) {
        std::string out;
        for (const auto& [key, value] : numbers) {
            const auto& all = effect.info->parameters;
            const auto p = std::find_if(all.begin(), all.end(), [&](const Parameter& q) { return q.key == key; });
            out += (out.empty() ? "" : ", ") + key + " " + number(value) +
                   (p == all.end() || p->unit == "1" ? "" : " " + std::string(p->unit));
        }
        return out;
    };
    PageTable out{"Effects found", {"effect", "parameters", "p", "held out without it", "held out with it"}, {}};
    for (const FittedEffect& effect : found.effects) {
        std::string parameters = told(effect, effect.parameters);
        for (const auto& [run, numbers] : effect.of_runs)
            if (run != effect.of_runs.begin()->first) parameters += "; recording " + run + ": " + told(effect, numbers);
        out.rows.push_back({effect.name, parameters, number(effect.p_value, 2), number(effect.held_out_before),
                            number(effect.held_out_after)});
    }
    return out;
}

PageTable candidate_table(const Explanation& found) {
    PageTable out{"All candidates", {"effect", "held-out error", "p", "fitted", "refused because"}, {}};
    for (const Candidate& c : found.candidates) {
        std::string fitted;
        for (const auto& [key, value] : c.parameters)
            fitted += (fitted.empty() ? "" : ", ") + key + " " + number(value, 3);
        out.rows.push_back({c.name, number(c.held_out_rms), std::isnan(c.held_out_rms) ? "" : number(c.p_value, 2),
                            fitted, c.refused_because.empty() ? "taken" : c.refused_because});
    }
    return out;
}

/// Every so manieth row, so that a curve has few points, with a gap where a run ends.
PlotCurve thinned(const Dataset& data, const std::vector<double>& x, const std::vector<double>& y, std::string label,
                  CurveStyle style, bool line) {
    PlotCurve out;
    out.label = std::move(label);
    out.style = style;
    out.line = line;
    out.marks = !line;
    const std::size_t step = std::max<std::size_t>(1, data.rows() / most_points);
    for (std::size_t i = 0; i < data.rows(); i += step) {
        if (line && i > 0 && data.run[i] != data.run[i - std::min(i, step)]) {
            out.x.push_back(x[i]);
            out.y.push_back(std::numeric_limits<double>::quiet_NaN());
        }
        out.x.push_back(x[i]);
        out.y.push_back(y[i]);
    }
    return out;
}

/// Runs one after another.
std::vector<double> joined_time(const Dataset& data) {
    std::vector<double> out;
    double offset = 0.0, last = 0.0;
    for (std::size_t i = 0; i < data.rows(); ++i) {
        if (i > 0 && data.run[i] != data.run[i - 1]) offset += last + 1.0;
        last = data.time_s[i];
        out.push_back(offset + data.time_s[i]);
    }
    return out;
}

Plot spectrum_plot(const Dataset& data, const std::vector<double>& residual, const DataColumn& column) {
    Plot out;
    out.title = "Spectrum of what is left in " + column.name;
    out.x_label = "period, s";
    out.y_label = "part of the variance";
    PlotCurve curve{"", {}, {}, CurveStyle::best, true, false};
    auto peaks = highest_peaks(data.time_s, residual, data.run, 0.0, std::numeric_limits<double>::infinity(), 200);
    std::sort(peaks.begin(), peaks.end(),
              [](const SpectrumPeak& a, const SpectrumPeak& b) { return a.period_s < b.period_s; });
    for (const SpectrumPeak& peak : peaks) {
        curve.x.push_back(peak.period_s);
        curve.y.push_back(peak.explained);
    }
    out.curves = {curve};
    return out;
}

void add_plots(const Dataset& data, const Explanation& found, Page& page) {
    const auto measured = data.of_role(ColumnRole::measured);
    const std::vector<double> time = joined_time(data);
    for (std::size_t c = 0; c < measured.size(); ++c) {
        const std::string label = measured[c]->name;
        std::vector<double> before, after;
        for (std::size_t i = 0; i < data.rows(); ++i) {
            before.push_back(measured[c]->values[i] - found.before[c][i]);
            after.push_back(measured[c]->values[i] - found.after[c][i]);
        }
        Plot both;
        both.title = "Measured and modelled: " + label;
        both.x_label = "time, s, runs one after another";
        both.y_label = label;
        both.curves = {thinned(data, time, measured[c]->values, "measured", CurveStyle::reference, true),
                       thinned(data, time, before, "before", CurveStyle::first, true),
                       thinned(data, time, after, "after", CurveStyle::best, true)};
        page.plots.push_back(std::move(both));
        Plot left;
        left.title = "Residual: " + label;
        left.x_label = "time, s, runs one after another";
        left.y_label = label;
        left.zero_line = true;
        left.curves = {thinned(data, time, found.before[c], "before", CurveStyle::first, true),
                       thinned(data, time, found.after[c], "after", CurveStyle::best, true)};
        page.plots.push_back(std::move(left));
        page.plots.push_back(spectrum_plot(data, found.after[c], *measured[c]));
    }
    const std::vector<Regressor> all = regressors(data);
    for (const Structure& s : found.left_over) {
        const auto by =
            std::find_if(all.begin(), all.end(), [&](const Regressor& r) { return r.name == s.depends_on; });
        if (by == all.end()) continue;
        for (std::size_t c = 0; c < measured.size(); ++c) {
            Plot plot;
            plot.title = "What is left in " + measured[c]->name + " against " + by->name;
            plot.x_label = by->name;
            plot.y_label = measured[c]->name;
            plot.zero_line = true;
            plot.curves = {thinned(data, by->values, found.after[c], "", CurveStyle::best, false)};
            page.plots.push_back(std::move(plot));
        }
    }
}

}  // namespace

std::vector<std::string> explain_sentences(const Dataset& data, const Explanation& found) {
    std::vector<std::string> out;
    const std::string unit = unit_of(data).empty() ? "" : " " + unit_of(data);
    std::string names;
    for (const FittedEffect& effect : found.effects) names += (names.empty() ? "" : ", ") + effect.name;
    out.push_back("Verdict: " + verdict_text(found.verdict) + (names.empty() ? "" : ": " + names) +
                  ". Held-out error " + number(found.held_out_before) + unit + " before, " +
                  number(found.held_out_after) + unit + " after; noise floor " + number(found.noise_floor) + unit +
                  (data.sensor_noise > 0.0 ? ", declared" : ", estimated from neighbouring rows") + ".");
    if (found.model_error > 0.0)
        out.push_back("The base model itself is off by about " + number(found.model_error) + unit +
                      " (what finer particles change of it): no effect is named for less.");
    if (data.sensor_noise > 0.0)
        out.push_back("Differences of neighbouring rows of what is left say " + number(found.estimated_noise) + unit +
                      " of noise.");
    if (!found.ambiguous_with.empty()) {
        std::string others;
        for (const std::string& name : found.ambiguous_with) others += (others.empty() ? "'" : ", '") + name + "'";
        out.push_back("These data do not tell it from " + others + ". " + found.parting + ".");
    }
    if (found.left_over.empty()) {
        out.push_back("What is left has no form that was looked for.");
    } else {
        std::string left;
        for (const Structure& s : found.left_over) left += (left.empty() ? "" : "; ") + s.text;
        out.push_back("What is left: " + left + ".");
    }
    if (found.empirical) {
        std::string terms;
        for (const EmpiricalTerm& t : found.empirical->terms)
            terms +=
                (terms.empty() ? "" : "; ") + t.column + ": " + number(t.coefficient, 3) + " a unit of " + t.regressor;
        out.push_back("No known effect says more. As numbers without a mechanism: " + terms + "; held-out error " +
                      number(found.empirical->held_out_rms) + unit + " with them.");
    }
    for (const std::string& sentence : found.cannot) out.push_back(sentence + ".");
    return out;
}

Page explain_page(const Dataset& data, const Explanation& found, const std::string& command) {
    Page page;
    page.title = "What the model lacks: " + data.title;
    page.paragraphs = explain_sentences(data, found);
    page.paragraphs.push_back("Data: " + data.source + ", kind " + data.kind + ", " + std::to_string(data.rows()) +
                              " rows in " + std::to_string(data.run_names.size()) + " recordings.");
    page.tables.push_back(error_table(data, found));
    if (!found.effects.empty()) page.tables.push_back(effect_table_of(found));
    page.tables.push_back(candidate_table(found));
    if (!found.base_parameters.empty()) {
        PageTable base{"Base model", {"number", "value"}, {}};
        for (const auto& [name, value] : found.base_parameters) base.rows.push_back({name, number(value)});
        page.tables.push_back(std::move(base));
    }
    add_plots(data, found, page);
    page.command = command;
    return page;
}

}  // namespace cathlab
