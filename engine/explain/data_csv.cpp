#include "explain/data_csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "core/check.h"
#include "core/errors.h"
#include "explain/dataset_kinds.h"
#include "scene/toml_document.h"

namespace cathlab {
namespace {

constexpr std::uint64_t largest_file = 512ULL << 20U;
constexpr std::size_t fewest_rows = 8;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct Suffix {
    std::string_view ending;
    std::string_view unit;
    double factor;
};
constexpr Suffix suffixes[] = {
    {"_mm", "mm", 1.0},   {"_m", "mm", 1000.0},    {"_deg", "deg", 1.0}, {"_rad", "deg", 57.29577951308232},
    {"_ms", "s", 1e-3},   {"_s", "s", 1.0},        {"_mn", "mN", 1.0},   {"_n", "mN", 1000.0},
    {"_kpa", "kPa", 1.0}, {"_mpa", "kPa", 1000.0}, {"_au", "au", 1.0}};

std::vector<std::string_view> split_line(std::string_view line) {
    std::vector<std::string_view> out;
    while (true) {
        const auto comma = line.find(',');
        std::string_view cell = line.substr(0, comma);
        while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
        while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\t' || cell.back() == '\r'))
            cell.remove_suffix(1);
        out.push_back(cell);
        if (comma == std::string_view::npos) return out;
        line.remove_prefix(comma + 1);
    }
}

/// nullopt-like: false where the cell is no finite number.  An empty cell is NaN.
bool parse_number(std::string_view cell, double& out) {
    if (cell.empty()) {
        out = nan;
        return true;
    }
    if (cell.front() == '+') cell.remove_prefix(1);
    const auto [end, fault] = std::from_chars(cell.data(), cell.data() + cell.size(), out);
    return fault == std::errc() && end == cell.data() + cell.size() && std::isfinite(out);
}

/// The text of a file by rows, with the place for every complaint.
class Table {
public:
    explicit Table(const std::string& path) : path_(path), text_(read_text_file(path, largest_file)) {
        std::string_view rest = text_;
        int line_number = 0;
        while (!rest.empty()) {
            const auto end = rest.find('\n');
            const std::string_view line = rest.substr(0, end);
            ++line_number;
            if (line.find_first_not_of(" \t\r") != std::string_view::npos) add(line, line_number);
            if (end == std::string_view::npos) break;
            rest.remove_prefix(end + 1);
        }
        if (header.empty()) throw UserError({path, 0, ""}, "is empty; a header and rows are wanted");
        if (rows() < fewest_rows)
            throw UserError({path, 0, ""}, "has " + std::to_string(rows()) + " rows; at least " +
                                               std::to_string(fewest_rows) + " are wanted");
    }

    std::size_t rows() const { return lines_.size(); }
    std::size_t find(const std::string& name) const {
        return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
    }
    bool has(const std::string& name) const { return find(name) < header.size(); }
    std::string_view cell(std::size_t row, std::size_t column) const { return cells_[row * header.size() + column]; }

    double number(std::size_t row, std::size_t column) const {
        double value = nan;
        if (!parse_number(cell(row, column), value))
            refuse(row, column,
                   "found '" + std::string(cell(row, column)) + "'; a finite number or an empty cell is wanted");
        return value;
    }
    [[noreturn]] void refuse(std::size_t row, std::size_t column, const std::string& sentence) const {
        throw UserError({path_, lines_[row], "column " + header[column]}, sentence);
    }
    [[noreturn]] void refuse_header(const std::string& sentence) const { throw UserError({path_, 1, ""}, sentence); }

    std::vector<std::string> header;

private:
    void add(std::string_view line, int number) {
        const auto cells = split_line(line);
        if (header.empty()) {
            for (const std::string_view cell : cells) {
                if (cell.empty()) throw UserError({path_, number, ""}, "a column has no name");
                if (has(std::string(cell)))
                    throw UserError({path_, number, std::string(cell)}, "stands twice in the header");
                header.emplace_back(cell);
            }
            return;
        }
        if (cells.size() != header.size())
            throw UserError({path_, number, ""}, "has " + std::to_string(cells.size()) + " cells; the header has " +
                                                     std::to_string(header.size()));
        cells_.insert(cells_.end(), cells.begin(), cells.end());
        lines_.push_back(number);
    }

    std::string path_, text_;
    std::vector<std::string_view> cells_;  // into text_
    std::vector<int> lines_;
};

void read_runs_and_time(const Table& table, Dataset& out) {
    if (!table.has("t_s")) table.refuse_header("the column t_s is missing");
    const std::size_t time = table.find("t_s");
    const std::size_t run = table.find("run");
    std::map<std::string, Index> known;
    std::vector<double> last;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        const std::string name = table.has("run") ? std::string(table.cell(row, run)) : "0";
        if (name.empty()) table.refuse(row, run, "is empty; the name of a run is wanted");
        const auto [it, is_new] = known.emplace(name, static_cast<Index>(out.run_names.size()));
        if (is_new) {
            out.run_names.push_back(name);
            last.push_back(-std::numeric_limits<double>::infinity());
        }
        const double t = table.number(row, time);
        double& before = last[static_cast<std::size_t>(it->second)];
        if (std::isnan(t)) table.refuse(row, time, "is empty; a time is wanted");
        if (t <= before)
            table.refuse(row, time,
                         "time does not rise within the run: " + std::to_string(t) + " s after " +
                             std::to_string(before) + " s");
        before = t;
        out.run.push_back(it->second);
        out.time_s.push_back(t);
    }
}

void read_part(const Table& table, Dataset& out) {
    if (!table.has("part")) return;
    const std::size_t column = table.find("part");
    std::size_t held_out = 0;
    for (std::size_t row = 0; row < table.rows(); ++row) {
        const std::string_view word = table.cell(row, column);
        if (word != "train" && word != "val")
            table.refuse(row, column, "found '" + std::string(word) + "'; train or val is wanted");
        out.held_out.push_back(word == "val" ? 1 : 0);
        held_out += word == "val" ? 1 : 0;
    }
    if (held_out == 0 || held_out == table.rows())
        table.refuse(0, column, "the column has one word only; both train and val are wanted");
}

DataColumn describe(const std::string& name) {
    DataColumn column;
    column.name = column.quantity = name;
    for (const Suffix& suffix : suffixes) {
        if (!name.ends_with(suffix.ending) || name.size() == suffix.ending.size()) continue;
        column.quantity = name.substr(0, name.size() - suffix.ending.size());
        column.unit = suffix.unit;
        break;
    }
    return column;
}

double factor_of(const std::string& name) {
    for (const Suffix& suffix : suffixes)
        if (name.ends_with(suffix.ending) && name.size() > suffix.ending.size()) return suffix.factor;
    return 1.0;
}

void read_columns(const Table& table, Dataset& out) {
    for (std::size_t c = 0; c < table.header.size(); ++c) {
        const std::string& name = table.header[c];
        if (name == "run" || name == "t_s" || name == "part") continue;
        DataColumn column = describe(name);
        double value = nan;
        bool any_number = false;
        bool any_text = false;
        for (std::size_t row = 0; row < table.rows(); ++row) {
            if (table.cell(row, c).empty()) continue;
            (parse_number(table.cell(row, c), value) ? any_number : any_text) = true;
        }
        if (any_text && !any_number && column.unit.empty()) {
            LabelColumn label{name, {}};
            for (std::size_t row = 0; row < table.rows(); ++row) label.values.emplace_back(table.cell(row, c));
            out.labels.push_back(std::move(label));
            continue;
        }
        const double factor = factor_of(name);
        for (std::size_t row = 0; row < table.rows(); ++row) column.values.push_back(factor * table.number(row, c));
        out.columns.push_back(std::move(column));
    }
}

void give_roles(const Table& table, Dataset& out) {
    const DatasetKind* kind = find_dataset_kind(out.kind);
    CATHLAB_CHECK(kind != nullptr, "the kind is checked before the table is read");
    const auto find = [&](const KnownColumn& known) -> DataColumn* {
        for (DataColumn& column : out.columns)
            if (column.quantity == known.quantity && column.unit == known.unit) return &column;
        return nullptr;
    };
    const auto shown = [](const KnownColumn& known) {
        return "'" + known.quantity + "'" + (known.unit.empty() ? "" : " in " + known.unit + " or a unit like it");
    };
    for (const KnownColumn& known : kind->inputs) {
        DataColumn* column = find(known);
        if (column == nullptr)
            table.refuse_header("kind " + out.kind + " needs the column " + shown(known) + "; found " +
                                comma_list(table.header) + did_you_mean(known.quantity, table.header));
        column->role = ColumnRole::input;
    }
    const auto whole = [&](const std::vector<KnownColumn>& set) {
        return std::all_of(set.begin(), set.end(), [&](const KnownColumn& known) { return find(known) != nullptr; });
    };
    const auto set = std::find_if(kind->measured.begin(), kind->measured.end(), whole);
    if (set == kind->measured.end()) {
        std::string wanted;
        for (const auto& choice : kind->measured) {
            wanted += wanted.empty() ? "" : ", or ";
            for (const KnownColumn& known : choice)
                wanted += (known.quantity == choice[0].quantity ? "" : ", ") + shown(known);
        }
        table.refuse_header("kind " + out.kind + " needs the measured columns " + wanted + "; found " +
                            comma_list(table.header));
    }
    for (const KnownColumn& known : *set) find(known)->role = ColumnRole::measured;
    for (const KnownColumn& known : kind->optional_measured)
        if (DataColumn* column = find(known)) column->role = ColumnRole::measured;
}

}  // namespace

void read_data_csv(const std::string& path, Dataset& out) {
    const Table table(path);
    read_runs_and_time(table, out);
    read_part(table, out);
    read_columns(table, out);
    give_roles(table, out);
}

}  // namespace cathlab
