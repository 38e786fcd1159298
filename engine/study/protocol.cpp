#include "study/protocol.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "core/errors.h"
#include "record/run_files.h"
#include "study/run_index.h"

namespace cathlab {
namespace fs = std::filesystem;
namespace {

constexpr const char* protocol_file = "/study.json";
constexpr const char* participants_file = "/participants.csv";
constexpr const char* participants_header = "pseudonym,group,synthetic";
constexpr int most_trials = 20;

void check_names(const char* key, const std::vector<std::string>& names) {
    if (names.empty()) throw UserError(std::string("a study needs at least one of its ") + key);
    std::set<std::string> seen;
    for (const std::string& name : names) {
        const bool plain = !name.empty() && name.size() <= 32 &&
                           name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
                               std::string::npos;
        if (!plain)
            throw UserError(std::string(key) + ": '" + name + "' is no name: letters, digits, '-' and '_', at most 32");
        if (!seen.insert(name).second) throw UserError(std::string(key) + ": '" + name + "' stands there twice");
    }
}

std::string lower(std::string text) {
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

}  // namespace

void check_protocol(const Protocol& protocol) {
    check_names("groups", protocol.groups);
    check_names("tasks", protocol.tasks);
    if (protocol.trials < 1 || protocol.trials > most_trials)
        throw UserError("trials: found " + std::to_string(protocol.trials) + "; allowed: 1 to " +
                        std::to_string(most_trials));
}

std::vector<int> balanced_order(int tasks, int participant) {
    std::vector<int> out;
    for (int k = 0; k < tasks; ++k) {
        const int zigzag = k == 0 ? 0 : k % 2 == 1 ? (k + 1) / 2 : tasks - k / 2;
        out.push_back((zigzag + participant) % tasks);
    }
    return out;
}

void write_study(const std::string& folder, const Protocol& protocol) {
    check_protocol(protocol);
    if (fs::exists(folder + protocol_file)) throw UserError(folder + ": holds a study already");
    std::error_code error;
    fs::create_directories(folder + "/runs", error);
    if (error) throw UserError(folder + ": cannot be made: " + error.message());
    const nlohmann::ordered_json out{{"schema", 1},
                                     {"name", protocol.name},
                                     {"groups", protocol.groups},
                                     {"tasks", protocol.tasks},
                                     {"trials", protocol.trials}};
    write_whole_file(folder + participants_file, std::string(participants_header) + "\n");
    write_whole_file(folder + protocol_file, out.dump(2) + "\n");
}

Protocol read_study(const std::string& folder) {
    const std::string path = folder + protocol_file;
    std::ifstream in(path);
    if (!in) throw UserError(folder + ": is no study (it has no study.json); cathlab study init makes one");
    const auto json = nlohmann::json::parse(in, nullptr, false);
    if (!json.is_object()) throw UserError(path + ": is not a JSON object");
    for (const auto& [key, value] : json.items()) {
        const std::vector<std::string> known{"schema", "name", "groups", "tasks", "trials"};
        if (std::find(known.begin(), known.end(), key) == known.end())
            throw UserError({path, 0, key}, "is no key of a study" + did_you_mean(key, known));
    }
    Protocol out;
    try {
        if (json.at("schema").get<int>() != 1)
            throw UserError({path, 0, "schema"}, "is of a newer version; 1 is known");
        out.name = json.value("name", "");
        out.groups = json.at("groups").get<std::vector<std::string>>();
        out.tasks = json.at("tasks").get<std::vector<std::string>>();
        out.trials = json.value("trials", out.trials);
        check_protocol(out);
    } catch (const nlohmann::json::exception& error) {
        throw UserError(path + ": " + error.what());
    } catch (const UserError& error) {
        throw UserError(path + ": " + error.what());
    }
    return out;
}

std::vector<Participant> read_participants(const std::string& folder, const Protocol& protocol) {
    const std::string path = folder + participants_file;
    const std::vector<std::string> lines = read_lines(path, true);
    if (lines.empty() || lines.front() != participants_header)
        throw UserError({path, 1, ""}, std::string("the header must be ") + participants_header);
    std::vector<Participant> out;
    std::set<std::string> seen;
    for (std::size_t k = 1; k < lines.size(); ++k) {
        const SourcePlace where{path, static_cast<int>(k + 1), ""};
        const std::string& line = lines[k];
        const std::size_t one = line.find(','), two = one == std::string::npos ? one : line.find(',', one + 1);
        if (two == std::string::npos) throw UserError(where, "found '" + line + "'; three cells are wanted");
        const Participant p{line.substr(0, one), line.substr(one + 1, two - one - 1), line.substr(two + 1) == "yes"};
        try {
            check_pseudonym(p.pseudonym);
        } catch (const UserError& error) {
            throw UserError(where, error.what());
        }
        if (!seen.insert(lower(p.pseudonym)).second) throw UserError(where, "'" + p.pseudonym + "' stands there twice");
        if (std::find(protocol.groups.begin(), protocol.groups.end(), p.group) == protocol.groups.end())
            throw UserError(where, "there is no group '" + p.group + "'" + did_you_mean(p.group, protocol.groups));
        out.push_back(p);
    }
    return out;
}

void add_participant(const std::string& folder, const Protocol& protocol, const Participant& participant) {
    check_pseudonym(participant.pseudonym);
    if (std::find(protocol.groups.begin(), protocol.groups.end(), participant.group) == protocol.groups.end()) {
        const std::string near = did_you_mean(participant.group, protocol.groups);
        throw UserError("there is no group '" + participant.group + "'" + near +
                        (near.empty() ? "; there is: " : " There is: ") + comma_list(protocol.groups));
    }
    std::vector<Participant> all = read_participants(folder, protocol);
    for (const Participant& other : all)
        if (lower(other.pseudonym) == lower(participant.pseudonym))
            throw UserError("'" + participant.pseudonym + "' takes part already");
    all.push_back(participant);
    std::string text = std::string(participants_header) + "\n";
    for (const Participant& p : all) text += p.pseudonym + "," + p.group + "," + (p.synthetic ? "yes" : "no") + "\n";
    write_whole_file(folder + participants_file, text);
}

std::vector<Trial> schedule(const Protocol& protocol, const std::vector<Participant>& participants) {
    std::vector<Trial> out;
    for (std::size_t p = 0; p < participants.size(); ++p)
        for (int trial = 1; trial <= protocol.trials; ++trial)
            for (const int task : balanced_order(static_cast<int>(protocol.tasks.size()), static_cast<int>(p))) {
                const std::string& name = protocol.tasks[static_cast<std::size_t>(task)];
                out.push_back({participants[p].pseudonym, participants[p].group, name, trial, participants[p].synthetic,
                               "runs/" + participants[p].pseudonym + "/" + name + "-" + std::to_string(trial)});
            }
    return out;
}

std::string trial_json(const Trial& trial) {
    const nlohmann::ordered_json out{{"participant", trial.participant},
                                     {"group", trial.group},
                                     {"task", trial.task},
                                     {"trial", trial.trial},
                                     {"synthetic", trial.synthetic}};
    return out.dump(2) + "\n";
}

}  // namespace cathlab
