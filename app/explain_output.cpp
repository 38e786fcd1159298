#include "explain_output.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "core/html_page.h"
#include "explain/report.h"
#include "record/run_files.h"

namespace cathlab {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 3> files{"result.json", "report.html", "overlay.toml"};

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json result_of(const Dataset& data, const Explanation& found, const ExplainOptions& options, double seconds) {
    Json effects = Json::array(), candidates = Json::array(), left = Json::array();
    for (const FittedEffect& effect : found.effects) {
        Json parameters = Json::object();
        for (const auto& [key, value] : effect.parameters) parameters[key] = number(value);
        Json of_runs = Json::object();
        for (const auto& [run, numbers] : effect.of_runs)
            for (const auto& [key, value] : numbers) of_runs[run][key] = number(value);
        effects.push_back({{"name", effect.name},
                           {"parameters", std::move(parameters)},
                           {"p_value", number(effect.p_value)},
                           {"held_out_rms_before", number(effect.held_out_before)},
                           {"held_out_rms_after", number(effect.held_out_after)}});
        if (!of_runs.empty()) effects.back()["parameters_of_runs"] = std::move(of_runs);
    }
    for (const Candidate& c : found.candidates)
        candidates.push_back(
            {{"name", c.name}, {"held_out_rms", number(c.held_out_rms)}, {"refused_because", c.refused_because}});
    for (const Structure& s : found.left_over)
        left.push_back({{"what", s.what},
                        {"period_s", s.period_s > 0.0 ? Json(s.period_s) : Json(nullptr)},
                        {"amplitude", number(s.amplitude)},
                        {"depends_on", s.depends_on},
                        {"text", s.text}});
    Json empirical = nullptr;
    if (found.empirical) {
        Json terms = Json::array();
        for (const EmpiricalTerm& t : found.empirical->terms)
            terms.push_back({{"column", t.column}, {"regressor", t.regressor}, {"coefficient", number(t.coefficient)}});
        empirical = {{"mechanism", "none: a fit without one"},
                     {"terms", std::move(terms)},
                     {"held_out_rms", number(found.empirical->held_out_rms)}};
    }
    Json base = Json::object();
    for (const auto& [name, value] : found.base_parameters) base[name] = number(value);
    return {{"dataset", fs::path(data.folder).lexically_normal().filename().string()},
            {"kind", data.kind},
            {"verdict", verdict_text(found.verdict)},
            {"effects", std::move(effects)},
            {"noise_floor_rms", number(found.noise_floor)},
            {"estimated_noise_rms", number(found.estimated_noise)},
            {"model_error_rms", number(found.model_error)},
            {"train_rms_before", number(found.train_before)},
            {"train_rms_after", number(found.train_after)},
            {"held_out_rms_before", number(found.held_out_before)},
            {"held_out_rms_after", number(found.held_out_after)},
            {"candidates", std::move(candidates)},
            {"ambiguous_with", found.ambiguous_with},
            {"parting_experiment", found.parting},
            {"residual_structure", std::move(left)},
            {"empirical", std::move(empirical)},
            {"base_parameters", std::move(base)},
            {"notes", found.cannot},
            {"seed", options.seed},
            {"version", CATHLAB_VERSION},
            {"seconds", seconds}};
}

}  // namespace

ExplainOutput::ExplainOutput(std::string folder) : folder_(std::move(folder)) {
    std::error_code error;
    if (!fs::exists(folder_, error)) {
        const fs::path parent = fs::absolute(folder_, error).lexically_normal().parent_path();
        if (!fs::is_directory(parent, error))
            throw UserError(folder_ + ": there is no folder '" + parent.string() + "' to make it in");
        return;
    }
    if (!fs::is_directory(folder_, error)) throw UserError(folder_ + ": is a file; a folder is wanted");
    for (const auto& entry : fs::directory_iterator(folder_, error)) {
        const std::string name = entry.path().filename().string();
        if (std::find(files.begin(), files.end(), name) == files.end())
            throw UserError(folder_ + ": holds '" + name + "', which no explanation has written; name another folder");
    }
    if (error) throw UserError(folder_ + ": cannot be read: " + error.message());
}

void ExplainOutput::write(const Dataset& data, const Explanation& found, const ExplainOptions& options, double seconds,
                          const std::string& command) const {
    const std::string page = html_page(explain_page(data, found, command));
    const std::string result = result_of(data, found, options, seconds).dump(2) + "\n";
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) throw UserError(folder_ + ": the folder cannot be made: " + error.message());
    const auto place = [&](const char* name) { return (fs::path(folder_) / name).string(); };
    if (found.overlay.empty())
        fs::remove(place(files[2]), error);
    else
        write_whole_file(place(files[2]), "# Effects found in " +
                                              fs::path(data.folder).lexically_normal().filename().string() +
                                              ": cathlab run SCENE --overlay " + files[2] + "\n\n" + found.overlay);
    write_whole_file(place(files[1]), page);
    write_whole_file(place(files[0]), result);
}

}  // namespace cathlab
