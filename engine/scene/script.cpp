#include "scene/script.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "beam/view_presets.h"
#include "core/csv.h"
#include "core/errors.h"
#include "scene/toml_document.h"

namespace cathlab {
namespace {

constexpr std::uint64_t most_script_bytes = 64ULL << 20U;
constexpr double longest_script_s = 86400.0;

double number_of(std::string_view cell, const SourcePlace& where, const std::string& wanted) {
    const auto value = finite_number(cell);
    if (!value) throw UserError(where, "found '" + shown(cell) + "'; " + wanted + " is wanted");
    return *value;
}

std::string number_text(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

const ActionInfo& action_of(std::string_view cell, SourcePlace where) {
    if (const ActionInfo* action = find_action(cell)) return *action;
    std::vector<std::string> known;
    for (const ActionInfo& a : action_table()) known.emplace_back(a.name);
    known.emplace_back("view");
    where.key = "action";
    throw UserError(where, "no action '" + shown(cell) + "'" + did_you_mean(std::string(cell), known) +
                               " There is: " + comma_list(known));
}

// Actions whose values have names: in their order from 0.
std::vector<std::string> value_names(std::string_view action) {
    if (action == "device") return {"wire", "catheter"};
    if (action == "acquisition") return {"fluoroscopy", "cine", "dsa"};
    if (action == "fluoroscopy_level") return {"low", "normal", "high"};
    return {};
}

double value_of(std::string_view cell, const ActionInfo& action, SourcePlace where) {
    where.key = std::string(action.name);
    const std::vector<std::string> names = value_names(action.name);
    for (std::size_t i = 0; i < names.size(); ++i)
        if (cell == names[i]) return static_cast<double>(i);
    std::string wanted = "a number from " + number_text(action.minimum) + " to " + number_text(action.maximum) +
                         (action.unit == "1" ? "" : " " + std::string(action.unit));
    if (!names.empty()) {
        wanted = names.front();
        for (std::size_t i = 1; i < names.size(); ++i) wanted += (i + 1 < names.size() ? ", " : " or ") + names[i];
    }
    const double value = number_of(cell, where, wanted);
    const bool named = names.empty() || value == std::floor(value);
    if (value < action.minimum || value > action.maximum || !named)
        throw UserError(where, "found " + shown(cell) + "; " + wanted + " is wanted");
    return value;
}

const ViewPreset& view_of(std::string_view cell, SourcePlace where) {
    if (const ViewPreset* view = find_view(cell)) return *view;
    where.key = "view";
    throw UserError(where, "no view '" + shown(cell) + "'" + did_you_mean(std::string(cell), view_names()) +
                               " There is: " + comma_list(view_names()));
}

}  // namespace

Input base_input(const SceneSpec& scene) {
    Input input;
    input.primary_angle = scene.c_arm.primary_deg;
    input.secondary_angle = scene.c_arm.secondary_deg;
    input.fluoroscopy_level = scene.c_arm.dose == "low" ? 0.0 : scene.c_arm.dose == "high" ? 2.0 : 1.0;
    return input;
}

Script::Script() : rows_(action_table().size()) {}

Script Script::load(const std::string& path) {
    return parse(read_text_file(path, most_script_bytes), path);
}

Script Script::parse(const std::string& text, const std::string& file) {
    Script out;
    SourcePlace where{file, 0, ""};
    bool header = false;
    for (CsvLines lines(text); lines.next();) {
        where.line = lines.number();
        const auto cells = lines.cells();
        if (!header) {
            if (cells != std::vector<std::string_view>{"t_s", "action", "value"})
                throw UserError(where,
                                "found '" + shown(lines.text()) + "'; the header t_s,action,value is wanted first");
            header = true;
            continue;
        }
        if (cells.size() != 3)
            throw UserError(where,
                            "found " + std::to_string(cells.size()) + " cells; the three t_s,action,value are wanted");
        const SourcePlace time_place{file, where.line, "t_s"};
        const double t = number_of(cells[0], time_place, "a time in seconds");
        if (t < 0.0 || t > longest_script_s)
            throw UserError(time_place, "found " + shown(cells[0]) + "; a time from 0 to 86400 s is wanted");
        if (t < out.end_s_)
            throw UserError(time_place,
                            "time runs back: " + shown(cells[0]) + " s after " + number_text(out.end_s_) + " s");
        const auto rows_of = [&](const ActionInfo& action) -> auto& {
            return out.rows_[static_cast<std::size_t>(&action - action_table().data())];
        };
        if (cells[1] == "view") {  // both angles at once: a jump, which the C-arm follows at its speed
            const ViewPreset& view = view_of(cells[2], where);
            for (const auto& [name, angle] :
                 {std::pair("primary_angle", view.primary_deg), std::pair("secondary_angle", view.secondary_deg)}) {
                auto& rows = rows_of(*find_action(name));
                if (!rows.empty()) rows.emplace_back(t, rows.back().second);
                rows.emplace_back(t, angle);
            }
        } else {
            const ActionInfo& action = action_of(cells[1], where);
            rows_of(action).emplace_back(t, value_of(cells[2], action, where));
        }
        out.end_s_ = t;
    }
    if (!header) throw UserError({file, 0, ""}, "is empty; the header t_s,action,value is wanted first");
    return out;
}

Input Script::at(double t, const Input& base) const {
    Input input = base;
    const auto actions = action_table();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const auto& rows = rows_[i];
        const auto next = std::upper_bound(rows.begin(), rows.end(), t,
                                           [](double time, const auto& row) { return time < row.first; });
        if (next == rows.begin()) continue;
        const auto& last = *std::prev(next);
        double value = last.second;
        if (actions[i].interpolation == Interpolation::linear && next != rows.end())
            value += (next->second - last.second) * (t - last.first) / (next->first - last.first);
        input.*actions[i].value = value;
    }
    return input;
}

std::size_t Script::row_count() const {
    std::size_t count = 0;
    for (const auto& rows : rows_) count += rows.size();
    return count;
}

}  // namespace cathlab
