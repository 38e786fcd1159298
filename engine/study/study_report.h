// The report of a study: who did how well, and what can be said of it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/html_page.h"
#include "study/protocol.h"
#include "study/questionnaire.h"
#include "study/run_index.h"
#include "task/force_map.h"

namespace cathlab {

/// What the runs of a group that count did to the unrolled aorta, in sum.
struct GroupForces {
    std::string group;
    int runs = 0;
    UnrolledForces forces;
};

/// One map a group, impulse a run, all to one scale; none where no run left a force map.
std::vector<HeatMap> force_maps(const std::vector<GroupForces>& groups);

/// Every answer sheet of a group.
struct GroupAnswers {
    std::string group;
    std::vector<Answers> sheets;
};

/// The statements of the Likert sheet, one picture a group as figure 9 of [li2025]; groups without an answer are left
/// out.
std::vector<StackedBars> likert_bars(const std::vector<GroupAnswers>& groups);

/// Usability score and raw task load by group, mean ± SD (n); no rows where nobody answered.
PageTable scales_table(const std::vector<GroupAnswers>& groups);

/// What the report says of one run beside its figures.
struct TrialNote {
    std::string page;      ///< where the run can be watched, relative to the report; "" = nowhere
    std::string verified;  ///< "yes", or what differs from what the inputs give; "" = nobody looked
};

/// Time and collision by task and group as in [li2025] table 2 (mean, SD, Kruskal and Wallis), then medians, quartiles,
/// bootstrap intervals, Mann-Whitney with Holm's correction, Cliff's delta, learning curves and every trial.  The last
/// trial of each task counts.  What cannot be computed stands as "-" with a sentence why.  notes: by the runs' folders.
Page study_page(const Protocol& protocol, const std::vector<Participant>& participants,
                const std::vector<RunEntry>& runs, const std::map<std::string, TrialNote>& notes = {});

/// One row a run, every metric a column.
std::string trials_csv(const std::vector<RunEntry>& runs);

}  // namespace cathlab
