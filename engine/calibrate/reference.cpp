#include "calibrate/reference.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "core/csv.h"
#include "scene/toml_document.h"

namespace cathlab {
namespace {

constexpr std::uint64_t most_bytes = 16ULL << 20U;
constexpr double most_kpa = 1e6;
constexpr double most_strain = 10.0;
constexpr double most_mm = 40.0;
constexpr std::size_t most_columns = 200;
constexpr std::size_t least_curve_rows = 3, least_beat_rows = 5;

/// A quantity that a file must give: its name and the units that may follow it, with their factors.
struct Quantity {
    std::string name;
    std::vector<std::pair<std::string, double>> units;  ///< suffix of the column ("_kpa"), factor to ours

    std::vector<std::string> columns() const {
        std::vector<std::string> out;
        for (const auto& [suffix, factor] : units) out.push_back(name + suffix);
        return out;
    }
};

std::string number_text(double value) {
    char buffer[64];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

struct Row {
    int line = 0;
    std::vector<std::string_view> cells;
};

/// A file cut into cells; the text is kept beside the views into it.
class Table {
public:
    explicit Table(const std::string& path) : file_(path), text_(read_text_file(path, most_bytes)) {
        for (CsvLines lines(text_); lines.next();) {
            if (header_.cells.empty())
                read_header({lines.number(), lines.cells()});
            else
                add_row({lines.number(), lines.cells()});
        }
        if (header_.cells.empty())
            throw UserError({file_, 0, ""}, "is empty; a line with the columns' names is wanted first");
    }

    const std::string& file() const { return file_; }
    const std::vector<Row>& rows() const { return rows_; }
    std::vector<int> lines() const {
        std::vector<int> out;
        for (const Row& row : rows_) out.push_back(row.line);
        return out;
    }

    std::optional<std::size_t> find(const std::string& column) const {
        for (std::size_t i = 0; i < header_.cells.size(); ++i)
            if (header_.cells[i] == column) return i;
        return {};
    }

    /// The one column that gives the quantity, with its factor; throws where there is none, or two.
    std::vector<double> column(const Quantity& quantity) const {
        std::optional<std::pair<std::size_t, double>> found;
        for (const auto& [suffix, factor] : quantity.units) {
            const auto index = find(quantity.name + suffix);
            if (!index) continue;
            if (found)
                throw UserError(
                    place(quantity.name + suffix),
                    "stands beside '" + std::string(header_.cells[found->first]) + "'; one of them is wanted");
            found = {*index, factor};
        }
        if (!found) refuse(quantity.name, quantity.columns());
        std::vector<double> out;
        for (const Row& row : rows_) out.push_back(found->second * number(row, found->first));
        return out;
    }

    double number(const Row& row, std::size_t column) const {
        const std::string_view cell = row.cells[column];
        const auto value = finite_number(cell);
        if (!value)
            throw UserError({file_, row.line, std::string(header_.cells[column])},
                            cell.empty() ? "is empty; a finite number is wanted"
                                         : "found '" + shown(cell) + "'; a finite number is wanted");
        return *value;
    }

    /// No column of these names: tells a missing or unknown unit from a missing column.
    [[noreturn]] void refuse(const std::string& quantity, const std::vector<std::string>& known) const {
        std::vector<std::string> there;
        for (const std::string_view cell : header_.cells) there.push_back(shown(cell));
        for (const std::string& column : there) {
            if (column != quantity && !column.starts_with(quantity + "_")) continue;
            throw UserError(place(column), std::string(column == quantity ? "names no unit" : "is in an unknown unit") +
                                               "; allowed: " + comma_list(known));
        }
        std::string near;
        for (const std::string& column : there)
            if (near.empty()) near = did_you_mean(column, known);
        throw UserError({file_, header_.line, ""}, "no column for the " + quantity + " among " + comma_list(there) +
                                                       "; wanted: " + comma_list(known) + near);
    }

private:
    SourcePlace place(const std::string& column) const { return {file_, header_.line, column}; }

    void read_header(Row row) {
        if (row.cells.size() > most_columns)
            throw UserError({file_, row.line, ""}, "names more than " + std::to_string(most_columns) + " columns");
        double number = 0.0;
        const std::string_view first = row.cells.front();
        if (std::from_chars(first.data(), first.data() + first.size(), number).ptr != first.data())
            throw UserError({file_, row.line, ""},
                            "begins with '" + shown(first) + "'; a line with the columns' names is wanted first");
        for (std::size_t i = 0; i < row.cells.size(); ++i)
            if (std::find(row.cells.begin(), row.cells.begin() + static_cast<std::ptrdiff_t>(i), row.cells[i]) !=
                row.cells.begin() + static_cast<std::ptrdiff_t>(i))
                throw UserError({file_, row.line, shown(row.cells[i])}, "a second column of this name");
        header_ = std::move(row);
    }

    void add_row(Row row) {
        if (row.cells.size() != header_.cells.size())
            throw UserError({file_, row.line, ""}, "found " + std::to_string(row.cells.size()) +
                                                       " cells; the header has " +
                                                       std::to_string(header_.cells.size()));
        rows_.push_back(std::move(row));
    }

    std::string file_;
    std::string text_;
    Row header_;
    std::vector<Row> rows_;
};

SourcePlace place_of(const std::string& file, const std::vector<int>& line, std::size_t row,
                     const std::string& column) {
    const bool known = row < line.size();
    return {file.empty() ? "the reference" : file, known ? line[row] : 0,
            known ? column : "row " + std::to_string(row + 1) + ", " + column};
}

void check_size(const std::string& file, std::size_t a, std::size_t b, std::size_t least) {
    const SourcePlace whole{file.empty() ? "the reference" : file, 0, ""};
    if (a != b) throw UserError(whole, "its columns are not of one length");
    if (a < least)
        throw UserError(whole, "has " + std::to_string(a) + (a == 1 ? " row" : " rows") + "; at least " +
                                   std::to_string(least) + " are wanted");
}

void check_number(const SourcePlace& place, double value, double least, double most, const std::string& hint) {
    if (!std::isfinite(value)) throw UserError(place, "a number is not finite");
    if (value < least || value > most)
        throw UserError(place, "found " + number_text(value) + "; allowed: " + number_text(least) + " to " +
                                   number_text(most) + hint);
}

}  // namespace

void check(const StressStrain& reference) {
    const std::vector<double>& stress = reference.stress_kpa;
    check_size(reference.file, stress.size(), reference.strain.size(), least_curve_rows);
    if (!reference.run.empty() && reference.run.size() != stress.size())
        throw UserError({reference.file, 0, ""}, "its columns are not of one length");
    std::map<int, std::pair<std::size_t, int>> last;  // of each run: its last row, and the sign of its way so far
    for (std::size_t i = 0; i < stress.size(); ++i) {
        const SourcePlace stress_place = place_of(reference.file, reference.line, i, "stress");
        check_number(stress_place, stress[i], -most_kpa, most_kpa, " kPa");
        check_number(place_of(reference.file, reference.line, i, "strain"), reference.strain[i], -1.0, most_strain,
                     " as a fraction; percent belong in a column strain_percent");
        const int run = reference.run.empty() ? 0 : reference.run[i];
        const auto [it, first] = last.try_emplace(run, i, 0);
        if (first) continue;
        auto& [row, way] = it->second;
        const int sign = stress[i] > stress[row] ? 1 : stress[i] < stress[row] ? -1 : 0;
        if (sign * way < 0)
            throw UserError(stress_place, "the stress turns round: " + number_text(stress[i]) + " after " +
                                              number_text(stress[row]) + " kPa; within a run it rises or falls");
        if (sign != 0) way = sign;
        row = i;
    }
}

StressStrain read_stress_strain(const std::string& path) {
    const Table table(path);
    StressStrain out;
    out.file = table.file();
    out.line = table.lines();
    out.stress_kpa = table.column({"stress", {{"_kpa", 1.0}, {"_mpa", 1000.0}, {"_pa", 0.001}}});
    out.strain = table.column({"strain", {{"", 1.0}, {"_percent", 0.01}}});
    if (const auto run = table.find("run"))
        for (const Row& row : table.rows()) {
            const double number = table.number(row, *run);
            if (number != std::floor(number) || std::fabs(number) > 1e6)
                throw UserError({out.file, row.line, "run"},
                                "found " + number_text(number) + "; a whole number is wanted");
            out.run.push_back(static_cast<int>(number));
        }
    check(out);
    return out;
}

StressStrain within(const StressStrain& reference, double low_kpa, double high_kpa) {
    StressStrain out;
    out.file = reference.file;
    for (std::size_t i = 0; i < reference.stress_kpa.size(); ++i) {
        if (reference.stress_kpa[i] < low_kpa || reference.stress_kpa[i] > high_kpa) continue;
        out.stress_kpa.push_back(reference.stress_kpa[i]);
        out.strain.push_back(reference.strain[i]);
        if (!reference.run.empty()) out.run.push_back(reference.run[i]);
        if (!reference.line.empty()) out.line.push_back(reference.line[i]);
    }
    if (out.strain.size() < least_curve_rows)
        throw UserError({out.file, 0, ""}, "has " + std::to_string(out.strain.size()) + " rows from " +
                                               number_text(low_kpa) + " to " + number_text(high_kpa) +
                                               " kPa; at least " + std::to_string(least_curve_rows) + " are wanted");
    return out;
}

void check(const BeatMotion& reference) {
    check_size(reference.file, reference.phase.size(), reference.displacement_mm.size(), least_beat_rows);
    for (std::size_t i = 0; i < reference.phase.size(); ++i) {
        const SourcePlace place = place_of(reference.file, reference.line, i, "phase");
        check_number(place, reference.phase[i], 0.0, 1.0, " of one beat");
        check_number(place_of(reference.file, reference.line, i, "displacement"), reference.displacement_mm[i],
                     -most_mm, most_mm, " mm");
        if (i > 0 && reference.phase[i] <= reference.phase[i - 1])
            throw UserError(place, "phase " + number_text(reference.phase[i]) + " after " +
                                       number_text(reference.phase[i - 1]) + "; from row to row it must rise");
    }
    constexpr double same_mm = 1e-6;
    if (reference.phase.front() == 0.0 && reference.phase.back() == 1.0 &&
        std::fabs(reference.displacement_mm.front() - reference.displacement_mm.back()) > same_mm)
        throw UserError(place_of(reference.file, reference.line, reference.phase.size() - 1, "displacement"),
                        "the beat ends at " + number_text(reference.displacement_mm.back()) + " mm and begins at " +
                            number_text(reference.displacement_mm.front()) + "; phases 0 and 1 are the same moment");
}

BeatMotion read_beat_motion(const std::string& path, double beat_s) {
    const Table table(path);
    BeatMotion out;
    out.file = table.file();
    out.line = table.lines();
    const bool timed = table.find("t_s") || table.find("t_ms");
    if (timed && table.find("phase"))
        throw UserError({out.file, 0, ""}, "has both a phase and a time; one of them is wanted");
    if (timed) {
        out.phase = table.column({"t", {{"_s", 1.0}, {"_ms", 0.001}}});
        for (std::size_t i = 0; i < out.phase.size(); ++i) {
            if (out.phase[i] < 0.0 || out.phase[i] > beat_s * (1.0 + 1e-9))
                throw UserError({out.file, out.line[i], "t"},
                                "found " + number_text(out.phase[i]) + " s; one beat is wanted, 0 to " +
                                    number_text(beat_s) + " s at " + number_text(60.0 / beat_s) + " a minute");
            out.phase[i] = std::min(1.0, out.phase[i] / beat_s);
        }
    } else {
        if (!table.find("phase")) table.refuse("phase", {"phase", "t_s", "t_ms"});
        out.phase = table.column({"phase", {{"", 1.0}}});
    }
    out.displacement_mm = table.column({"displacement", {{"_mm", 1.0}, {"_cm", 10.0}, {"_m", 1000.0}}});
    check(out);
    return out;
}

double at_phase(const BeatMotion& reference, double phase) {
    const std::vector<double>& at = reference.phase;
    const std::size_t n = at.size();
    const double p = phase - std::floor(phase);
    const auto next = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), p) - at.begin());
    const std::size_t before = next == 0 ? n - 1 : next - 1, after = next == n ? 0 : next;
    const double start = next == 0 ? at[before] - 1.0 : at[before];
    const double end = next == n ? at[after] + 1.0 : at[after];
    const double t = end > start ? (p - start) / (end - start) : 0.0;
    return reference.displacement_mm[before] +
           t * (reference.displacement_mm[after] - reference.displacement_mm[before]);
}

}  // namespace cathlab
