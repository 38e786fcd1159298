// Which runs there are, who did them, and what they scored.  The run folders are the truth; the index is an SQLite file
// that can be rebuilt from them at any time.  Participants are known by pseudonym alone.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace cathlab {

struct RunEntry {
    std::string folder;       ///< relative to the index's root, with '/'
    std::string participant;  ///< pseudonym: letters, digits, '-' and '_', at most 32; "" = nobody in particular
    std::string group;        ///< "novice", ...; may be empty
    std::string task;         ///< may be empty
    int trial = 0;            ///< from 1 within participant and task; 0 = not part of a protocol
    std::string scene;
    std::string scene_hash;
    std::string version;  ///< of the program that recorded it
    bool complete = true;
    /// Name -> value: task's metric table, and what result.json says, as goal_reached (0 or 1), score (0 to 100) and
    /// the seconds for which each aid was looked at.
    std::map<std::string, double> metrics;
};

/// Reads FOLDER/manifest.json, FOLDER/trial.json where there is one ({"participant", "group", "task", "trial"}: who did
/// what), FOLDER/metrics.json (which an incomplete run may lack), and FOLDER/result.json where there is one.  Throws
/// UserError that names the file and what is wrong with it.
RunEntry read_run_folder(const std::string& root, const std::string& folder);

/// Throws UserError unless the text can be a pseudonym; a name with a blank or an '@' is refused.
void check_pseudonym(const std::string& text);

class RunIndex {
public:
    /// Opens or makes the index file; root is the folder below which the runs stand.  Throws UserError where the file
    /// cannot be opened, is no index, or is of a newer format.
    RunIndex(const std::string& file, const std::string& root);
    ~RunIndex();
    RunIndex(RunIndex&&) noexcept;
    RunIndex& operator=(RunIndex&&) noexcept;

    /// Adds or replaces the entry of that folder.  Throws UserError for a bad pseudonym, an empty folder, or a trial of
    /// that participant and task that another folder holds already.
    void add(const RunEntry& entry);

    /// Empty filters take all.  Ordered by participant, task, trial, folder.
    std::vector<RunEntry> list(const std::string& participant = "", const std::string& task = "") const;

    struct Rebuilt {
        int added = 0;
        std::vector<std::string> left_out;  ///< one sentence a folder that could not be read
    };
    /// Forgets all entries and reads every folder below root that holds a manifest.json.  All or nothing: an error
    /// leaves the index as it was.
    Rebuilt rebuild();

private:
    struct Database;
    std::unique_ptr<Database> database_;
};

}  // namespace cathlab
