// A study folder: who is to do what, in which order, and what is done.
//
//     study.json         the protocol: groups, tasks, trials of each
//     participants.csv   pseudonym,group,synthetic: in the order in which they came
//     runs/P/TASK-N      one run folder a trial, with trial.json
//     index.sqlite       of the runs; rebuilt from the folders at any time
#pragma once

#include <string>
#include <vector>

namespace cathlab {

struct Protocol {
    std::string name;
    std::vector<std::string> groups;
    std::vector<std::string> tasks;  ///< names of scenes/tasks
    int trials = 2;                  ///< of each task and participant; the last one counts, those before are to learn
};

struct Participant {
    std::string pseudonym;
    std::string group;
    bool synthetic = false;  ///< an autopilot, marked so wherever it appears
};

struct Trial {
    std::string participant, group, task;
    int trial = 1;
    bool synthetic = false;
    std::string folder;  ///< relative to the study's
};

/// Throws UserError: no group, no task, the same twice, trials not in 1 to 20, a name that is no file name.
void check_protocol(const Protocol& protocol);

/// The order of n tasks for the participant of this number (from 0): row k of a Latin square in which, for even n, each
/// task follows each other one equally often [williams1949].
std::vector<int> balanced_order(int tasks, int participant);

/// A new study; the folder must not hold one.  Throws UserError.
void write_study(const std::string& folder, const Protocol& protocol);
/// Throws UserError that names the file, and the key or line.
Protocol read_study(const std::string& folder);
std::vector<Participant> read_participants(const std::string& folder, const Protocol& protocol);
/// Throws UserError for a bad pseudonym, one that is there already (in any case of letters), an unknown group.
void add_participant(const std::string& folder, const Protocol& protocol, const Participant& participant);

/// All trials in the order in which each participant goes through them: all first trials, then all second ones.
std::vector<Trial> schedule(const Protocol& protocol, const std::vector<Participant>& participants);

/// trial.json
std::string trial_json(const Trial& trial);

}  // namespace cathlab
