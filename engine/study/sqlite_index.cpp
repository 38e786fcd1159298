#include <sqlite3.h>

#include <algorithm>
#include <filesystem>

#include "core/errors.h"
#include "study/run_index.h"

namespace cathlab {
namespace {

constexpr int format = 1;  // kept in SQLite's user_version

constexpr const char* schema = R"(
CREATE TABLE run (folder TEXT PRIMARY KEY, participant TEXT, "group" TEXT, task TEXT, trial INTEGER, scene TEXT,
                  scene_hash TEXT, version TEXT, complete INTEGER);
CREATE UNIQUE INDEX one_run_a_trial ON run (participant, task, trial) WHERE trial > 0;
CREATE TABLE metric (folder TEXT REFERENCES run (folder) ON DELETE CASCADE, name TEXT, value REAL,
                     PRIMARY KEY (folder, name));
PRAGMA user_version = 1;
)";

/// One prepared statement; parameters are bound in order, columns are read by number.
class Statement {
public:
    Statement(sqlite3* db, const char* sql) : db_(db) {
        if (sqlite3_prepare_v2(db, sql, -1, &statement_, nullptr) != SQLITE_OK) fail();
    }
    ~Statement() { sqlite3_finalize(statement_); }
    Statement(const Statement&) = delete;
    Statement& operator=(const Statement&) = delete;

    Statement& bind(const std::string& text) {
        sqlite3_bind_text(statement_, ++bound_, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
        return *this;
    }
    Statement& bind(int number) {
        sqlite3_bind_int(statement_, ++bound_, number);
        return *this;
    }
    Statement& bind(double number) {
        sqlite3_bind_double(statement_, ++bound_, number);
        return *this;
    }
    /// True while there is a row.
    bool step() {
        const int code = sqlite3_step(statement_);
        if (code != SQLITE_ROW && code != SQLITE_DONE) fail();
        return code == SQLITE_ROW;
    }
    std::string text(int column) const {
        const auto* found = sqlite3_column_text(statement_, column);
        return found == nullptr ? "" : reinterpret_cast<const char*>(found);
    }
    int whole(int column) const { return sqlite3_column_int(statement_, column); }
    double number(int column) const { return sqlite3_column_double(statement_, column); }

private:
    [[noreturn]] void fail() const { throw UserError(std::string("the index of runs: ") + sqlite3_errmsg(db_)); }

    sqlite3* db_;
    sqlite3_stmt* statement_ = nullptr;
    int bound_ = 0;
};

}  // namespace

struct RunIndex::Database {
    sqlite3* db = nullptr;
    std::string file, root;

    ~Database() { sqlite3_close(db); }

    void execute(const char* sql) const {
        char* message = nullptr;
        if (sqlite3_exec(db, sql, nullptr, nullptr, &message) == SQLITE_OK) return;
        const std::string text = message == nullptr ? "unknown fault" : message;
        sqlite3_free(message);
        throw UserError(file + ": " + text);
    }

    /// All that `work` does, or nothing of it.
    template <class Work>
    void transaction(const Work& work) const {
        execute("BEGIN IMMEDIATE");
        try {
            work();
            execute("COMMIT");
        } catch (...) {
            sqlite3_exec(db, "ROLLBACK", nullptr, nullptr, nullptr);
            throw;
        }
    }

    void insert(const RunEntry& e) const {
        if (e.folder.empty()) throw UserError("a run needs a folder");
        if (!e.participant.empty()) check_pseudonym(e.participant);
        if (e.trial > 0) {
            Statement other(db,
                            "SELECT folder FROM run WHERE participant = ? AND task = ? AND trial = ? AND folder <> ?");
            other.bind(e.participant).bind(e.task).bind(e.trial).bind(e.folder);
            if (other.step())
                throw UserError(e.folder + ": trial " + std::to_string(e.trial) + " of task '" + e.task + "' by '" +
                                e.participant + "' is already in " + other.text(0));
        }
        Statement(db, "DELETE FROM run WHERE folder = ?").bind(e.folder).step();
        Statement(db, "INSERT INTO run VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)")
            .bind(e.folder)
            .bind(e.participant)
            .bind(e.group)
            .bind(e.task)
            .bind(e.trial)
            .bind(e.scene)
            .bind(e.scene_hash)
            .bind(e.version)
            .bind(e.complete ? 1 : 0)
            .step();
        for (const auto& [name, value] : e.metrics)
            Statement(db, "INSERT INTO metric VALUES (?, ?, ?)").bind(e.folder).bind(name).bind(value).step();
    }
};

RunIndex::RunIndex(const std::string& file, const std::string& root) : database_(std::make_unique<Database>()) {
    database_->file = file;
    database_->root = root;
    if (sqlite3_open(file.c_str(), &database_->db) != SQLITE_OK)
        throw UserError(file + ": the index of runs cannot be opened: " + sqlite3_errmsg(database_->db));
    database_->execute("PRAGMA foreign_keys = ON");
    Statement version(database_->db, "PRAGMA user_version");
    const int found = version.step() ? version.whole(0) : 0;
    if (found > format)
        throw UserError(file + ": was written by a newer program (format " + std::to_string(found) +
                        ", known: " + std::to_string(format) + ")");
    if (found == 0) database_->transaction([&] { database_->execute(schema); });
}

RunIndex::~RunIndex() = default;
RunIndex::RunIndex(RunIndex&&) noexcept = default;
RunIndex& RunIndex::operator=(RunIndex&&) noexcept = default;

void RunIndex::add(const RunEntry& entry) {
    database_->transaction([&] { database_->insert(entry); });
}

std::vector<RunEntry> RunIndex::list(const std::string& participant, const std::string& task) const {
    Statement runs(database_->db,
                   "SELECT * FROM run WHERE (?1 = '' OR participant = ?1) AND (?2 = '' OR task = ?2) "
                   "ORDER BY participant, task, trial, folder");
    runs.bind(participant).bind(task);
    std::vector<RunEntry> out;
    while (runs.step()) {
        RunEntry e{runs.text(0), runs.text(1), runs.text(2), runs.text(3),       runs.whole(4),
                   runs.text(5), runs.text(6), runs.text(7), runs.whole(8) != 0, {}};
        Statement metrics(database_->db, "SELECT name, value FROM metric WHERE folder = ?");
        metrics.bind(e.folder);
        while (metrics.step()) e.metrics[metrics.text(0)] = metrics.number(1);
        out.push_back(std::move(e));
    }
    return out;
}

RunIndex::Rebuilt RunIndex::rebuild() {
    namespace fs = std::filesystem;
    std::error_code fault;
    std::vector<std::string> folders;
    fs::recursive_directory_iterator walk(database_->root, fs::directory_options::skip_permission_denied, fault);
    if (fault) throw UserError(database_->root + ": cannot be read: " + fault.message());
    Rebuilt out;
    for (; walk != fs::recursive_directory_iterator(); walk.increment(fault)) {
        if (fault) throw UserError(database_->root + ": cannot be read: " + fault.message());
        const fs::path& path = walk->path();
        if (path.extension() == ".part" && walk->is_directory()) {
            walk.disable_recursion_pending();
            out.left_out.push_back(path.lexically_relative(database_->root).generic_string() +
                                   ": a trial that was broken off; it is to be run again");
        } else if (path.filename() == "manifest.json") {
            folders.push_back(path.parent_path().lexically_relative(database_->root).generic_string());
        }
    }
    std::sort(folders.begin(), folders.end());
    std::sort(out.left_out.begin(), out.left_out.end());
    database_->transaction([&] {
        database_->execute("DELETE FROM run");
        for (const std::string& folder : folders) {
            try {
                database_->insert(read_run_folder(database_->root, folder));
                ++out.added;
            } catch (const UserError& e) {
                out.left_out.emplace_back(e.what());
            }
        }
    });
    return out;
}

}  // namespace cathlab
