#include "study/study_report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/svg_plot.h"
#include "record/run_writer.h"
#include "study/statistics.h"
#include "task/metrics.h"

namespace cathlab {
namespace {

struct Figure {
    const char* metric;
    const char* name;
};
// The paper's two first.
constexpr Figure figures[] = {{"play_time_s", "play time, s"},
                              {"accumulated_collision_n", "accumulated collision, N"},
                              {"collision_impulse_ns", "collision impulse, N s"},
                              {"force_bar_max", "largest force bar"},
                              {"fluoroscopy_time_s", "fluoroscopy time, s"},
                              {"score", "score of 100"}};
// Of result.json, beside the metrics.
constexpr const char* result_figures[] = {"goal_reached [1]", "score [1]", "inner_view_s [s]",
                                          "displacement_view_s [s]", "force_view_s [s]"};

std::string number(double value, int digits = 3) {
    return std::isfinite(value) ? plain_number(value, digits) : "-";
}

std::string p_text(double p) {
    if (!std::isfinite(p)) return "-";
    return p < 0.001 ? "< 0.001" : plain_number(p, 2);
}

class Table {
public:
    Table(const Protocol& protocol, const std::vector<RunEntry>& runs) : protocol_(protocol), runs_(runs) {}

    std::vector<double> values(const std::string& task, const std::string& group, int trial,
                               const std::string& metric) const {
        std::vector<double> out;
        for (const RunEntry& run : runs_) {
            if (run.task != task || run.group != group || run.trial != trial) continue;
            const auto found = run.metrics.find(metric);
            if (found != run.metrics.end() && std::isfinite(found->second)) out.push_back(found->second);
        }
        return out;
    }
    std::vector<std::vector<double>> by_group(const std::string& task, const std::string& metric) const {
        std::vector<std::vector<double>> out;
        for (const std::string& group : protocol_.groups) out.push_back(values(task, group, protocol_.trials, metric));
        return out;
    }

    PageTable means(const Figure& figure) const {
        PageTable out{std::string(figure.name) + ", mean ± SD (n)", {"task"}, {}};
        for (const std::string& group : protocol_.groups) out.header.push_back(group);
        out.header.emplace_back("Kruskal-Wallis p");
        for (const std::string& task : protocol_.tasks) {
            const auto groups = by_group(task, figure.metric);
            std::vector<std::string> row{task};
            for (const auto& v : groups)
                row.push_back(v.empty() ? "-"
                                        : number(mean(v)) + " ± " + number(standard_deviation(v)) + " (" +
                                              std::to_string(v.size()) + ")");
            row.push_back(p_text(kruskal_wallis(groups).p));
            out.rows.push_back(row);
        }
        return out;
    }

    PageTable reached() const {
        PageTable out{"Goal reached, of the trials that count", {"task"}, {}};
        for (const std::string& group : protocol_.groups) out.header.push_back(group);
        for (const std::string& task : protocol_.tasks) {
            std::vector<std::string> row{task};
            for (const auto& v : by_group(task, "goal_reached"))
                row.push_back(v.empty() ? "-"
                                        : std::to_string(std::count(v.begin(), v.end(), 1.0)) + " of " +
                                              std::to_string(v.size()));
            out.rows.push_back(row);
        }
        return out;
    }

    PageTable medians(const Figure& figure) const {
        PageTable out{
            std::string(figure.name) + ", median [quartiles], 95 % bootstrap interval of the median", {"task"}, {}};
        for (const std::string& group : protocol_.groups) out.header.push_back(group);
        for (const std::string& task : protocol_.tasks) {
            std::vector<std::string> row{task};
            for (const auto& v : by_group(task, figure.metric)) {
                if (v.empty()) {
                    row.emplace_back("-");
                    continue;
                }
                const Interval ci = bootstrap_interval(v, [](std::span<const double> s) { return median(s); });
                row.push_back(number(median(v)) + " [" + number(quantile(v, 0.25)) + ", " + number(quantile(v, 0.75)) +
                              "], " + number(ci.low) + " to " + number(ci.high));
            }
            out.rows.push_back(row);
        }
        return out;
    }

    PageTable pairs(const Figure& figure) const {
        PageTable out{std::string(figure.name) + ", pairs of groups: Mann-Whitney (Holm over the table), Cliff's delta",
                      {"task", "groups", "p", "p by Holm", "delta"},
                      {}};
        std::vector<double> p;
        for (const std::string& task : protocol_.tasks) {
            const auto groups = by_group(task, figure.metric);
            for (std::size_t a = 0; a < groups.size(); ++a)
                for (std::size_t b = a + 1; b < groups.size(); ++b) {
                    const bool both = !groups[a].empty() && !groups[b].empty();
                    p.push_back(both ? mann_whitney(groups[a], groups[b]).p : std::nan(""));
                    out.rows.push_back({task, protocol_.groups[a] + " against " + protocol_.groups[b], p_text(p.back()),
                                        "", both ? number(cliffs_delta(groups[a], groups[b]), 2) : "-"});
                }
        }
        const std::vector<double> corrected = holm(p);
        for (std::size_t k = 0; k < corrected.size(); ++k) out.rows[k][3] = p_text(corrected[k]);
        return out;
    }

    Plot learning(const Figure& figure) const {
        Plot out;
        out.title = std::string("Learning: ") + figure.name + ", mean over participants and tasks";
        out.x_label = "trial";
        out.y_label = figure.name;
        for (std::size_t g = 0; g < protocol_.groups.size(); ++g) {
            PlotCurve curve{protocol_.groups[g], {}, {}, static_cast<CurveStyle>(g % 5), true, true};
            for (int trial = 1; trial <= protocol_.trials; ++trial) {
                std::vector<double> all;
                for (const std::string& task : protocol_.tasks)
                    for (const double v : values(task, protocol_.groups[g], trial, figure.metric)) all.push_back(v);
                curve.x.push_back(trial);
                curve.y.push_back(all.empty() ? std::nan("") : mean(all));
            }
            out.curves.push_back(std::move(curve));
        }
        return out;
    }

private:
    const Protocol& protocol_;
    const std::vector<RunEntry>& runs_;
};

TrialNote note_of(const std::map<std::string, TrialNote>& notes, const RunEntry& run) {
    const auto found = notes.find(run.folder);
    return found == notes.end() ? TrialNote() : found->second;
}

PageTable trials_table(const std::vector<RunEntry>& runs, const std::map<std::string, TrialNote>& notes) {
    PageTable out{
        "Every trial; cathlab play --replay FOLDER shows it as it was seen",
        {"folder", "group", "task", "trial", "goal", "score", "play time, s", "collision, N", "complete", "verified"},
        {}};
    const auto metric = [](const RunEntry& run, const char* name) {
        const auto found = run.metrics.find(name);
        return found == run.metrics.end() ? std::string("-") : number(found->second);
    };
    for (const RunEntry& run : runs) {
        const TrialNote note = note_of(notes, run);
        const auto reached = run.metrics.find("goal_reached");
        out.rows.push_back({run.folder, run.group, run.task, std::to_string(run.trial),
                            reached == run.metrics.end() ? "-"
                            : reached->second > 0.5      ? "reached"
                                                         : "not reached",
                            metric(run, "score"), metric(run, "play_time_s"), metric(run, "accumulated_collision_n"),
                            run.complete ? "yes" : "no", note.verified.empty() ? "-" : note.verified});
        out.links.push_back(note.page);
    }
    return out;
}

/// How many runs are what their inputs give, as far as somebody looked.
std::string verified_sentence(const std::vector<RunEntry>& runs, const std::map<std::string, TrialNote>& notes) {
    std::size_t looked = 0, agree = 0;
    for (const RunEntry& run : runs) {
        const std::string verified = note_of(notes, run).verified;
        looked += verified.empty() ? 0 : 1;
        agree += verified == "yes" ? 1 : 0;
    }
    if (looked == 0)
        return "Not verified: the figures are those that the runs stored (cathlab study report --verify steps them "
               "again).";
    return "Verified: of " + std::to_string(looked) + " runs stepped again from their inputs, " +
           std::to_string(agree) + " agree in every file, channel, hash and metric" +
           (agree == looked ? "." : "; the others are named in the last table.");
}

}  // namespace

std::vector<HeatMap> force_maps(const std::vector<GroupForces>& groups) {
    std::size_t columns = 0;
    double most = 0.0;
    for (const GroupForces& g : groups) {
        columns = std::max(columns, g.forces.impulse_ns.size() / UnrolledForces::sectors);
        for (const double v : g.forces.impulse_ns) most = std::max(most, v / std::max(1, g.runs));
    }
    std::vector<HeatMap> out;
    if (most <= 0.0) return out;
    for (const GroupForces& g : groups) {
        HeatMap map;
        map.title = "Where the wall was pressed: " + g.group + ", mean of " + std::to_string(g.runs) + " runs";
        map.x_label = "along the centre-line from the heart, mm";
        map.y_label = "about it, deg";
        map.value_label = "N s a run";
        map.x_step = UnrolledForces::along_mm;
        map.y_step = 360.0 / UnrolledForces::sectors;
        map.columns = static_cast<int>(columns);
        map.rows = UnrolledForces::sectors;
        map.most = most;
        map.values.assign(columns * UnrolledForces::sectors, 0.0);
        for (std::size_t i = 0; i < g.forces.impulse_ns.size(); ++i)
            map.values[(i % UnrolledForces::sectors) * columns + i / UnrolledForces::sectors] =
                g.forces.impulse_ns[i] / std::max(1, g.runs);
        out.push_back(std::move(map));
    }
    return out;
}

std::vector<StackedBars> likert_bars(const std::vector<GroupAnswers>& groups) {
    std::vector<StackedBars> out;
    const auto sheets = question_sheets();
    const auto likert = std::find_if(sheets.begin(), sheets.end(), [](const auto& s) { return s.id == "likert"; });
    if (likert == sheets.end()) return out;
    const auto place = static_cast<std::size_t>(likert - sheets.begin());
    for (const GroupAnswers& group : groups) {
        StackedBars bars;
        bars.title = "What they said: " + group.group + ", answers from 1, strongly disagree, to 5, strongly agree";
        for (int k = likert->least; k <= likert->most; k += likert->step) bars.parts.push_back(std::to_string(k));
        int all = 0;
        for (std::size_t q = 0; q < likert->questions.size(); ++q) {
            StackedBars::Row row{std::string(likert->questions[q].text), std::vector<int>(bars.parts.size(), 0)};
            for (const Answers& answers : group.sheets) {
                const auto& answer = answers.sheets[place][q];
                if (!answer) continue;
                ++row.counts[static_cast<std::size_t>((*answer - likert->least) / likert->step)];
                ++all;
            }
            bars.rows.push_back(std::move(row));
        }
        if (all > 0) out.push_back(std::move(bars));
    }
    return out;
}

PageTable scales_table(const std::vector<GroupAnswers>& groups) {
    PageTable out{"Questionnaires, mean ± SD (n)", {"group", "usability (SUS)", "task load (raw TLX)"}, {}};
    for (const GroupAnswers& group : groups) {
        std::vector<double> sus, tlx;
        for (const Answers& answers : group.sheets) {
            if (const auto score = sus_score(answers)) sus.push_back(*score);
            if (const auto score = tlx_score(answers)) tlx.push_back(*score);
        }
        if (sus.empty() && tlx.empty()) continue;
        const auto cell = [](const std::vector<double>& values) {
            return values.empty() ? std::string("-")
                                  : number(mean(values)) + " ± " + number(standard_deviation(values)) + " (" +
                                        std::to_string(values.size()) + ")";
        };
        out.rows.push_back({group.group, cell(sus), cell(tlx)});
    }
    return out;
}

Page study_page(const Protocol& protocol, const std::vector<Participant>& participants,
                const std::vector<RunEntry>& runs, const std::map<std::string, TrialNote>& notes) {
    Page page;
    page.title = "Study " + protocol.name;
    const auto synthetic =
        std::count_if(participants.begin(), participants.end(), [](const Participant& p) { return p.synthetic; });
    page.paragraphs.push_back(
        std::to_string(participants.size()) + " participants in " + std::to_string(protocol.groups.size()) +
        " groups, " + std::to_string(protocol.tasks.size()) + " tasks, " + std::to_string(protocol.trials) +
        " trials of each; " + std::to_string(runs.size()) + " runs are there." +
        (protocol.trials > 1 ? " Trial " + std::to_string(protocol.trials) + " counts, those before are to learn."
                             : ""));
    if (synthetic > 0)
        page.paragraphs.push_back("SYNTHETIC: " + std::to_string(synthetic) +
                                  " of the participants are autopilots. Nothing here speaks of people.");
    if (protocol.groups.size() < 2)
        page.paragraphs.emplace_back("One group: there is nothing to compare, so no test is computed.");
    if (runs.empty()) page.paragraphs.emplace_back("No run is there yet, so no figure can be computed.");
    if (!runs.empty()) page.paragraphs.push_back(verified_sentence(runs, notes));
    const Table table(protocol, runs);
    for (const Figure& figure : figures) {
        page.tables.push_back(table.means(figure));
        page.details.push_back(table.medians(figure));
        if (protocol.groups.size() > 1) page.details.push_back(table.pairs(figure));
    }
    page.tables.push_back(table.reached());
    if (protocol.trials > 1)
        for (const Figure& figure : {figures[0], figures[1]}) page.plots.push_back(table.learning(figure));
    page.details.push_back(trials_table(runs, notes));
    return page;
}

std::string trials_csv(const std::vector<RunEntry>& runs) {
    std::string out = "folder,participant,group,task,trial,complete,version";
    for (const MetricInfo& metric : metric_table())
        out += "," + std::string(metric.name) + " [" + std::string(metric.unit) + "]";
    for (const std::string column : result_figures) out += "," + column;
    out += "\n";
    for (const RunEntry& run : runs) {
        out += run.folder + "," + run.participant + "," + run.group + "," + run.task + "," + std::to_string(run.trial) +
               "," + (run.complete ? "yes" : "no") + "," + run.version;
        for (const MetricInfo& metric : metric_table()) {
            const auto found = run.metrics.find(std::string(metric.name));
            out += "," + (found == run.metrics.end() ? std::string() : exact_number(found->second));
        }
        for (const std::string column : result_figures) {
            const auto found = run.metrics.find(column.substr(0, column.find(' ')));
            out += "," + (found == run.metrics.end() ? std::string() : exact_number(found->second));
        }
        out += "\n";
    }
    return out;
}

}  // namespace cathlab
