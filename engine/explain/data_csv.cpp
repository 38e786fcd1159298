#include "explain/data_csv.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include "core/check.h"
#include "core/csv.h"
#include "core/errors.h"
#include "explain/dataset_kinds.h"
#include "scene/toml_document.h"

namespace cathlab {
namespace {

constexpr std::uint64_t largest_file = 512ULL << 20U;
constexpr std::size_t fewest_rows = 8;
constexpr std::size_t most_columns = 1000;
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

/// The text of a file by rows, with the place for every complaint.
class Table {
public:
    explicit Table(const std::string& path) : path_(path), text_(read_text_file(path, largest_file)) {
        for (CsvLines lines(text_); lines.next();) add(lines.cells(), lines.number());
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

    /// NaN for an empty cell.
    double number(std::size_t row, std::size_t column) const {
        const std::string_view text = cell(row, column);
        if (text.empty()) return nan;
        const auto value = finite_number(text);
        if (!value) refuse(row, column, "found '" + shown(text) + "'; a finite number or an empty cell is wanted");
        return *value;
    }
    [[noreturn]] void refuse(std::size_t row, std::size_t column, const std::string& sentence) const {
        throw UserError({path_, lines_[row], "column " + shown(header[column])}, sentence);
    }
    [[noreturn]] void refuse_header(const std::string& sentence) const {
        throw UserError({path_, header_line_, ""}, sentence);
    }
    std::vector<std::string> names_shown() const {
        std::vector<std::string> names;
        for (const std::string& name : header) names.push_back(shown(name));
        return names;
    }

    std::vector<std::string> header;

private:
    void add(const std::vector<std::string_view>& cells, int number) {
        if (header.empty()) {
            header_line_ = number;
            if (cells.size() > most_columns)
                throw UserError({path_, number, ""}, "names more than " + std::to_string(most_columns) + " columns");
            for (const std::string_view cell : cells) {
                if (cell.empty()) throw UserError({path_, number, ""}, "a column has no name");
                if (has(std::string(cell))) throw UserError({path_, number, shown(cell)}, "stands twice in the header");
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
    int header_line_ = 1;
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
            table.refuse(row, column, "found '" + shown(word) + "'; train or val is wanted");
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
        bool any_number = false;
        bool any_text = false;
        for (std::size_t row = 0; row < table.rows(); ++row) {
            const std::string_view cell = table.cell(row, c);
            if (!cell.empty()) (finite_number(cell) ? any_number : any_text) = true;
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
    const auto sentence = [](const KnownColumn& known) {
        return "'" + known.quantity + "'" + (known.unit.empty() ? "" : " in " + known.unit + " or a unit like it");
    };
    for (const KnownColumn& known : kind->inputs) {
        DataColumn* column = find(known);
        if (column == nullptr)
            table.refuse_header("kind " + out.kind + " needs the column " + sentence(known) + "; found " +
                                comma_list(table.names_shown()) + did_you_mean(known.quantity, table.names_shown()));
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
                wanted += (known.quantity == choice[0].quantity ? "" : ", ") + sentence(known);
        }
        table.refuse_header("kind " + out.kind + " needs the measured columns " + wanted + "; found " +
                            comma_list(table.names_shown()));
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
