#include "study/questionnaire.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/errors.h"

namespace cathlab {
namespace {

constexpr std::array<Question, 11> likert{{
    {"picture", "The fluoroscopy looked like that of a catheter laboratory."},
    {"device", "Guidewire and catheter moved as I expect real ones to move."},
    {"wall", "The vessels gave way and moved with heart and breath as I expect of real ones."},
    {"contact", "I noticed at once when a device touched the wall."},
    {"force_bar", "The force bar helped me to press less."},
    {"hands", "The controls did what I meant, when I meant it."},
    {"tremble", "The trembling of the gamepad told me about the force; with a keyboard: the tones did."},
    {"inner_view", "The views from the tip and from outside helped me to find the way."},
    {"goal", "I knew at all times what I was to do."},
    {"learnt", "I got better from trial to trial."},
    {"again", "I would prepare for a real procedure with this trainer."},
}};

constexpr std::array<Question, 10> sus{{
    {"sus1", "I think that I would like to use this system frequently."},
    {"sus2", "I found the system unnecessarily complex."},
    {"sus3", "I thought the system was easy to use."},
    {"sus4", "I think that I would need the support of a technical person to be able to use this system."},
    {"sus5", "I found the various functions in this system were well integrated."},
    {"sus6", "I thought there was too much inconsistency in this system."},
    {"sus7", "I would imagine that most people would learn to use this system very quickly."},
    {"sus8", "I found the system very cumbersome to use."},
    {"sus9", "I felt very confident using the system."},
    {"sus10", "I needed to learn a lot of things before I could get going with this system."},
}};

constexpr std::array<Question, 6> tlx{{
    {"mental", "Mental demand: how mentally demanding was the task?", "very low", "very high"},
    {"physical", "Physical demand: how physically demanding was the task?", "very low", "very high"},
    {"temporal", "Temporal demand: how hurried or rushed was the pace of the task?", "very low", "very high"},
    {"performance", "Performance: how successful were you in what you were asked to do?", "perfect", "failure"},
    {"effort", "Effort: how hard did you have to work for what you reached?", "very low", "very high"},
    {"frustration", "Frustration: how insecure, discouraged, irritated or stressed were you?", "very low", "very high"},
}};

constexpr std::array<QuestionSheet, 3> sheets{{
    {"likert", "How was the simulation?", likert},
    {"sus", "How was the system to use?", sus},
    {"tlx", "How was the task?", tlx, 0, 100, 5},
}};

enum : std::size_t { likert_sheet, sus_sheet, tlx_sheet };

nlohmann::ordered_json or_null(const auto& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
}

bool all_given(const std::vector<std::optional<int>>& answers) {
    return std::all_of(answers.begin(), answers.end(), [](const auto& a) { return a.has_value(); });
}

}  // namespace

std::span<const QuestionSheet> question_sheets() {
    return sheets;
}

Answers::Answers() {
    for (const QuestionSheet& sheet : question_sheets()) this->sheets.emplace_back(sheet.questions.size());
}

std::size_t Answers::given() const {
    std::size_t out = 0;
    for (const auto& sheet : sheets)
        out += static_cast<std::size_t>(std::count_if(sheet.begin(), sheet.end(), [](const auto& a) { return !!a; }));
    return out;
}

bool Answers::complete() const {
    return std::all_of(sheets.begin(), sheets.end(), all_given);
}

std::optional<double> sus_score(const Answers& answers) {
    const auto& given = answers.sheets[sus_sheet];
    if (!all_given(given)) return std::nullopt;
    int sum = 0;
    for (std::size_t i = 0; i < given.size(); ++i) sum += i % 2 == 0 ? *given[i] - 1 : 5 - *given[i];
    return 2.5 * sum;
}

std::optional<double> tlx_score(const Answers& answers) {
    const auto& given = answers.sheets[tlx_sheet];
    if (!all_given(given)) return std::nullopt;
    double sum = 0.0;
    for (const auto& a : given) sum += *a;
    return sum / static_cast<double>(given.size());
}

std::string questionnaire_json(const Answers& answers) {
    nlohmann::ordered_json out{{"schema", 1}, {"complete", answers.complete()}, {"skipped", answers.skipped}};
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        auto& sheet = out[std::string(sheets[s].id)] = nlohmann::ordered_json::object();
        for (std::size_t q = 0; q < sheets[s].questions.size(); ++q)
            sheet[std::string(sheets[s].questions[q].id)] = or_null(answers.sheets[s][q]);
    }
    out["sus_score"] = or_null(sus_score(answers));
    out["tlx_score"] = or_null(tlx_score(answers));
    return out.dump(2) + "\n";
}

Answers read_questionnaire(const std::string& path) {
    std::ifstream in(path);
    if (!in) throw UserError(path + ": cannot be read");
    const auto json = nlohmann::json::parse(in, nullptr, false);
    if (!json.is_object()) throw UserError(path + ": is not a JSON object");
    if (json.value("schema", nlohmann::json()) != 1)
        throw UserError({path, 0, "schema"}, "is of another version; 1 is known");
    Answers out;
    if (const auto it = json.find("skipped"); it != json.end() && it->is_boolean()) out.skipped = it->get<bool>();
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        const QuestionSheet& sheet = sheets[s];
        const auto it = json.find(std::string(sheet.id));
        if (it == json.end() || !it->is_object()) throw UserError({path, 0, std::string(sheet.id)}, "is missing");
        for (const auto& [key, value] : it->items()) {
            const auto question = std::find_if(sheet.questions.begin(), sheet.questions.end(),
                                               [&id = key](const Question& q) { return q.id == id; });
            if (question == sheet.questions.end())
                throw UserError({path, 0, std::string(sheet.id) + "." + key}, "is no question of this sheet");
            if (value.is_null()) continue;
            const bool whole = value.is_number_integer();
            const auto answer = whole ? value.get<std::int64_t>() : 0;
            if (!whole || answer < sheet.least || answer > sheet.most || (answer - sheet.least) % sheet.step != 0)
                throw UserError({path, 0, std::string(sheet.id) + "." + key},
                                "is " + value.dump() + "; " + std::to_string(sheet.least) + " to " +
                                    std::to_string(sheet.most) + " by " + std::to_string(sheet.step) + " is wanted");
            out.sheets[s][static_cast<std::size_t>(question - sheet.questions.begin())] = static_cast<int>(answer);
        }
    }
    return out;
}

}  // namespace cathlab
