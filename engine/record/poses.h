// poses.bin: what moves in a picture, as it stood at equal intervals of a run, so that `cathlab render` need not step
// it again.
//
// Little endian, numbers of 32 or 64 bits, no padding:
//
//     head    "cathposes" and seven zero bytes, u32 version, u32 vertices of the lumen, u32 nodes of the centre-line,
//             u32 0, u64 hash of the anatomy, f64 records a second, u64 sum of what precedes it
//     record  u64 step, u64 bytes of what follows the sum, u64 sum of the two and of those bytes, then
//               camera    u8 whether there is one, 3 f32 place, 3 f32 direction
//               devices   u32 number; each: u32 length of its name, the name; u32 points, 3 f32 each; u32 runs of alike
//                         pieces; each: u32 pieces, f32 radius, f32 radius of the bore (< 0: solid), u32 length and
//                         name of the material
//               wall      f32 unit, u32 runs of vertices that stand elsewhere than at rest; each: u32 first, u32
//                         number, 3 i16 displacement each, in units
//               force     u32 number; each: u32 vertex, f32 newtons
//               contrast  u32 number (0: none anywhere), f32 mg/mL each
//     end     as a record: step 2^64 - 1, its bytes a u64 number of records
//
// A vertex is read back within 0.002 mm of where it stood, or 1/30,000 of the largest displacement where that is more
// than 60 mm; everything else to the precision of a float.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/types.h"
#include "record/run_files.h"

namespace cathlab {

/// A wire or catheter: a chain of round pieces.
struct DevicePose {
    std::string name;
    std::vector<Vec3> points;               ///< (n + 1) joints, mm, world
    std::vector<double> radius_mm;          ///< (n) outer radius of each piece
    std::vector<double> inner_radius_mm;    ///< (n) of the bore; empty: solid
    std::vector<std::string> materials;     ///< names used below
    std::vector<std::uint8_t> material_of;  ///< (n) index into materials

    /// The index of a name, which is added where it is new.
    std::uint8_t material_index(const std::string& material);
};

/// What moves in a picture; all else follows from the scene and the step's channels.
struct ScenePoses {
    struct Tip {
        Vec3 position = Vec3::Zero();
        Vec3 forward = Vec3::UnitZ();  ///< unit vector
    };
    std::vector<Vec3> lumen;                             ///< (n) vertices, mm, world
    std::vector<std::pair<Index, double>> wall_force_n;  ///< vertex and force near it, N; ascending; no zeros
    std::vector<double> contrast_mg_ml;                  ///< one a node of the centre-line, or empty: none anywhere
    std::vector<DevicePose> devices;
    std::optional<Tip> tip;  ///< where the inner view looks from
};

/// What poses.bin must fit.
struct PosesFrame {
    const std::vector<Vec3>* rest = nullptr;  ///< the lumen's vertices at rest; outlives who uses it
    std::size_t nodes = 0;                    ///< of the centre-line
    std::uint64_t anatomy_hash = 0;
};

class PosesWriter {
public:
    /// rate_hz > 0.  Throws UserError where the file cannot be written; so do the others.
    PosesWriter(const std::string& folder, const PosesFrame& frame, double rate_hz);

    /// Whether poses are due after the step that ended at time_s: as a film's pictures are.
    bool due(double time_s) const { return time_s * rate_hz_ + 1e-9 >= static_cast<double>(count_); }
    void add(std::int64_t step, const ScenePoses& poses);
    void flush() { file_.flush(); }
    void close();

private:
    PosesFrame frame_;
    double rate_hz_;
    std::uint64_t count_ = 0;
    LineFile file_;
    std::string record_;  // kept for its memory
};

/// Whether a run folder has poses.
bool has_poses(const std::string& folder);

class PosesReader {
public:
    /// complete: the run was closed, so its last record must be there.  Throws UserError: no such file, another
    /// version, another anatomy, a sum that does not fit.
    PosesReader(const std::string& folder, const PosesFrame& frame, bool complete);

    double rate_hz() const { return rate_hz_; }
    /// Goes on to the last poses at or before the step (0 = the first), whose steps must not descend from call to call,
    /// and gives them.  Throws UserError: a record that is cut, changed or cannot be, and a step before the first
    /// record.
    const ScenePoses& at(std::int64_t step);

private:
    [[noreturn]] void fail(const std::string& what) const;
    bool read_head();  // of the next record; false at the end
    void read_poses();

    struct Closer {
        void operator()(std::FILE* f) const { std::fclose(f); }
    };
    std::string path_;
    PosesFrame frame_;
    bool complete_;
    double rate_hz_ = 0.0;
    std::unique_ptr<std::FILE, Closer> file_;
    std::uint64_t records_ = 0;  // whose bytes were read
    std::int64_t next_step_ = -1;
    bool ended_ = false, any_ = false;
    std::string bytes_, last_;       // of the next record and of the one before, whose sums were found to fit
    std::uint64_t last_record_ = 0;  // which that one is, from 1
    ScenePoses poses_;
};

}  // namespace cathlab
