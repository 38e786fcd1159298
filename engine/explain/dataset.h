// What a bench or a clinic recorded: a folder with dataset.toml and data.csv, read strictly.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/errors.h"
#include "core/types.h"

namespace cathlab {

enum class ColumnRole {
    input,     ///< what was done to the device; the kind knows it
    measured,  ///< what the sensor said; the kind knows it
    extra      ///< any other number: a possible explanation
};

/// A column of numbers.  A name that ends in a known unit (_mm _m _deg _rad _s _ms _n _mn _kpa _mpa _au) is read in it
/// and converted: m to mm, rad to deg, ms to s, N to mN, MPa to kPa.
struct DataColumn {
    std::string name;      ///< as the header has it
    std::string quantity;  ///< without its unit: "tip_x", "stress"
    std::string unit;      ///< after conversion: "mm", "deg", "s", "mN", "kPa", "au" or "" (none)
    ColumnRole role = ColumnRole::extra;
    std::vector<double> values;  ///< (rows) NaN where the cell is empty
};

struct LabelColumn {
    std::string name;
    std::vector<std::string> values;  ///< (rows)
};

struct HeartMotionSetup {
    std::vector<std::vector<double>> beat_times_s;  ///< one list a run, rising; empty = not recorded
    std::optional<Vec3> axis;                       ///< unit
};

struct CatheterTipSetup {
    double proximal_length_mm = 0.0, middle_length_mm = 0.0, distal_length_mm = 0.0, tip_length_mm = 0.0;
    Pose base;                 ///< world: z = direction of insertion, x = towards which a positive bend goes
    std::optional<Vec3> down;  ///< unit, direction of gravity; nothing = not known
};

struct TendonSegmentSetup {
    std::string name;
    double length_mm = 0.0;
    std::vector<std::string> tendons;  ///< names of columns, equally spaced around
    std::vector<std::size_t> columns;  ///< the same as indices into Dataset::columns
};

struct TendonTipSetup {
    double tendon_radius_mm = 0.0;
    std::vector<TendonSegmentSetup> segments;  ///< base first
};

struct WallTensionSetup {
    std::string specimen, mode;  ///< empty = not said
    double thickness_mm = 0.0;
};

/// A part of the wall that is held: within radius_mm of center_mm and half_thickness_mm of the plane through it.
struct HeldPlace {
    std::string name;
    Vec3 center_mm = Vec3::Zero(), normal = Vec3::UnitZ();
    double radius_mm = 0.0, half_thickness_mm = 0.0;
};

struct WallContactSetup {
    std::string mesh;        ///< path of the lumen's surface, mm; empty = a tube about z from 0
    SourcePlace mesh_place;  ///< for errors
    double tube_radius_mm = 0.0, tube_length_mm = 0.0;  ///< of the lumen
    double thickness_mm = 0.0, tool_radius_mm = 0.0;
    std::vector<Vec3> sensor_rest_mm;  ///< (runs) on the outer wall
    double young_modulus_kpa = 0.0, poisson = 0.0;
    std::vector<HeldPlace> held;
};

struct Dataset {
    std::string folder, kind, title, source, license;
    std::vector<std::string> declared_effects;
    double sensor_noise = 0.0;  ///< root mean square a measured column, in the column's unit; 0 = not known
    CatheterTipSetup catheter;  ///< filled for kind catheter-tip
    TendonTipSetup tendons;     ///< filled for kind tendon-tip
    HeartMotionSetup heart;     ///< filled for kind heart-motion
    WallTensionSetup wall;      ///< filled for kind wall-tension
    WallContactSetup contact;   ///< filled for kind wall-contact

    std::vector<Index> run;  ///< (rows) 0, 1, ... in order of appearance; all 0 where there is no column `run`
    std::vector<std::string> run_names;  ///< as the file has them
    std::vector<double> time_s;          ///< (rows) rises within a run
    std::vector<std::uint8_t> held_out;  ///< (rows) 1 = part "val"; empty where the file has no column `part`
    std::vector<DataColumn> columns;     ///< without run, t_s and part
    std::vector<LabelColumn> labels;

    std::size_t rows() const { return time_s.size(); }
    std::vector<const DataColumn*> of_role(ColumnRole role) const;
    const DataColumn* find(const std::string& quantity) const;  ///< nullptr where there is none
};

/// Reads the folder.  Throws UserError with file, line and column for whatever is not as the format says: a missing or
/// unknown key, a missing column, a cell that is no number, an infinity, time that does not rise, fewer than eight
/// rows.
Dataset read_dataset(const std::string& folder);

/// The kinds of data of the format.
const std::vector<std::string>& dataset_kinds();

}  // namespace cathlab
