// The names and small rules of a run folder, and files that are whole or not there.
//
//     manifest.json   what the run was made with; "complete": false until it ended by itself
//     inputs.jsonl    the source of truth: {"step": k, "input": {...}} whenever the input changes, {"end": n} last
//     trace.csv       every channel, one row a step, "name [unit]" in the header
//     events.jsonl    what happened, one object a line
//     hashes.csv      every 50 steps and after the last: steps done, whole state, each entity
//     poses.bin       what moves in a picture, see poses.h
//     metrics.json, poster.png, fluoro.mp4
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace cathlab {

inline constexpr std::int64_t hash_interval = 50;             ///< steps
inline constexpr std::uint64_t most_log_bytes = 4ULL << 30U;  ///< of a table that is read back

/// Writes NAME.part and renames it to NAME: the final name never holds half a file.  Throws UserError (full disk, ...).
void write_whole_file(const std::string& path, const std::string& text);

/// Makes the folder (and those above it).  An existing folder must be empty; with `replace` it may also be an earlier
/// run folder (it holds a manifest.json of this program), whose files of the names above are then removed, and no
/// others. Throws UserError where it cannot be made or written to.
void prepare_run_folder(const std::string& folder, bool replace);

/// The same questions without touching anything: for the start, before minutes are spent on building a world.
void check_run_folder(const std::string& folder, bool replace);

/// A file that grows by whole lines and survives a crash up to the last flush().  Every function throws UserError where
/// the disk is full or the file cannot be written.
class LineFile {
public:
    explicit LineFile(const std::string& path);
    void add(const std::string& line);
    /// Bytes as they are.
    void append(const std::string& bytes);
    void flush();
    /// Flushes to the disk itself.
    void close();

private:
    struct Closer {
        void operator()(std::FILE* f) const { std::fclose(f); }
    };
    [[noreturn]] void fail() const;
    std::string path_;
    std::unique_ptr<std::FILE, Closer> file_;
};

/// The lines of a text file without their ends.  Throws UserError where it cannot be read, is larger than `most_bytes`,
/// holds zero bytes, or its last line has no end (`complete`: then it was truncated; otherwise that line is dropped,
/// for the crash may have happened in the middle of it).
std::vector<std::string> read_lines(const std::string& path, bool complete);

}  // namespace cathlab
