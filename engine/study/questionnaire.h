// What a participant is asked after a trial, the answers, and the file that keeps them: questionnaire.json of a run
// folder.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace cathlab {

struct Question {
    std::string_view id;    ///< key in the file
    std::string_view text;  ///< a statement, or what is to be judged
    std::string_view low = "strongly disagree", high = "strongly agree";
};

/// A sheet of questions that are answered on one scale.
struct QuestionSheet {
    std::string_view id;     ///< key in the file
    std::string_view title;  ///< for the one who answers
    std::span<const Question> questions;
    int least = 1, most = 5, step = 1;  ///< of an answer
};

/// "likert": eleven statements on this simulator, 1 to 5.  "sus": the ten of the System Usability Scale [brooke1996],
/// 1 to 5.  "tlx": the six scales of NASA's task load index [hart1988], 0 to 100 by fives.
std::span<const QuestionSheet> question_sheets();

/// One answer a question of each sheet; empty = not given.
struct Answers {
    Answers();
    std::vector<std::vector<std::optional<int>>> sheets;
    bool skipped = false;  ///< the participant would not answer

    std::size_t given() const;
    bool complete() const;
};

/// 2.5 * (sum over odd items of (x - 1) + sum over even items of (5 - x)), 0 to 100; empty unless all ten are given.
std::optional<double> sus_score(const Answers& answers);
/// The raw index, the mean of the six scales [hart2006], 0 to 100; empty unless all six are given.
std::optional<double> tlx_score(const Answers& answers);

/// {"schema": 1, "complete", "skipped", "likert": {id: 1..5 or null}, "sus": {...}, "tlx": {...}, "sus_score",
/// "tlx_score"}
std::string questionnaire_json(const Answers& answers);
/// Throws UserError that names file and key: not there, no such file, an unknown question, an answer off its scale.
Answers read_questionnaire(const std::string& path);

}  // namespace cathlab
