// The curves in assets/reference against what their headers say of them (docs/reference-data.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {

/// A table of two columns under a header whose lines begin with '#'.
struct ReferenceTable {
    std::string header, columns;
    std::map<std::string, double> constants;  ///< of the header's lines "#   name = number"
    std::vector<double> x, y;
};

ReferenceTable read_reference(const std::string& name) {
    ReferenceTable table;
    std::ifstream file(std::string(CATHLAB_SOURCE_DIR) + "/assets/reference/" + name);
    const std::regex constant(R"(#   (\w+) = ([-+.\d]+))");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with('#')) {
            table.header += line + '\n';
            if (std::smatch m; std::regex_match(line, m, constant)) table.constants[m[1]] = std::stod(m[2]);
        } else if (table.columns.empty()) {
            table.columns = line;
        } else {
            std::istringstream row(line);
            double x = 0.0, y = 0.0;
            char comma = 0;
            EXPECT_TRUE(row >> x >> comma >> y && comma == ',' && row.eof()) << name << ": " << line;
            table.x.push_back(x), table.y.push_back(y);
        }
    }
    return table;
}

const ReferenceTable& aorta() {
    static const ReferenceTable table = read_reference("aorta-circumferential.csv");
    return table;
}

const ReferenceTable& annulus() {
    static const ReferenceTable table = read_reference("annulus-displacement.csv");
    return table;
}

/// Strain energy, kPa, of the law in the header of aorta-circumferential.csv at three principal stretches.
double energy(const std::map<std::string, double>& c, double hoop, double axial, double radial) {
    const double angle = c.at("angle_deg") * std::numbers::pi / 180.0;
    const double i1 = hoop * hoop + axial * axial + radial * radial;
    // Both families lie alike to the principal directions.
    const double i5 =
        std::pow(hoop, 4) * std::pow(std::cos(angle), 2) + std::pow(axial, 4) * std::pow(std::sin(angle), 2);
    return c.at("matrix_weight_kpa") * c.at("matrix_factor") * (i1 - 3.0) +
           c.at("exponential_weight_kpa") * (std::exp(c.at("exponential_factor") * (i1 - 3.0)) - 1.0) +
           2.0 * c.at("fibre_weight_kpa") * c.at("fibre_factor") * (i5 - 1.0) * (i5 - 1.0);
}

/// Cauchy stress of a thin tube whose length is held: what the energy gains with the stretch, the wall thinning as the
/// volume demands, times the stretch.
double hoop_stress(const std::map<std::string, double>& c, double stretch) {
    const double d = 1e-5;
    const auto held = [&](double l) { return energy(c, l, 1.0, 1.0 / l); };
    return stretch * (held(stretch + d) - held(stretch - d)) / (2.0 * d);
}

double at_phase(double phase) {
    const auto found =
        std::find_if(annulus().x.begin(), annulus().x.end(), [&](double p) { return std::abs(p - phase) < 1e-9; });
    return found == annulus().x.end() ? std::nan("") : annulus().y[std::size_t(found - annulus().x.begin())];
}

double milliseconds(double phase) {
    return phase * 60000.0 / annulus().constants.at("rate_bpm");
}

void expect_sources(const ReferenceTable& table, std::size_t at_least) {
    std::ifstream file(std::string(CATHLAB_SOURCE_DIR) + "/docs/references.md");
    std::stringstream references;
    references << file.rdbuf();
    const std::regex key(R"(\[([a-z]+\d{4}[a-z]?)\])");
    std::map<std::string, int> keys;
    for (std::sregex_iterator it(table.header.begin(), table.header.end(), key), end; it != end; ++it) ++keys[(*it)[1]];
    EXPECT_GE(keys.size(), at_least);
    for (const auto& [name, times] : keys)
        EXPECT_NE(references.str().find("- [" + name + "] "), std::string::npos) << name;
}

}  // namespace

TEST(AortaReference, GoesFromNothingTo580KilopascalsInThirtyRisingRows) {
    EXPECT_EQ(aorta().columns, "stress_kpa,strain");
    ASSERT_EQ(aorta().x.size(), 30U);
    for (std::size_t i = 0; i < 30; ++i) EXPECT_DOUBLE_EQ(aorta().x[i], 20.0 * double(i));
    for (std::size_t i = 1; i < 30; ++i) EXPECT_GT(aorta().y[i], aorta().y[i - 1]);
    EXPECT_DOUBLE_EQ(aorta().y[0], 0.0);
}

TEST(AortaReference, EveryRowObeysTheLawAndTheConstantsOfItsHeader) {
    ASSERT_EQ(aorta().constants.size(), 7U);
    EXPECT_NEAR(hoop_stress(aorta().constants, 1.0), 0.0, 1e-6);
    for (std::size_t i = 1; i < aorta().x.size(); ++i)
        EXPECT_NEAR(hoop_stress(aorta().constants, 1.0 + aorta().y[i]) / aorta().x[i], 1.0, 1e-3) << aorta().x[i];
}

TEST(AortaReference, AWallThatIsStretchedFurtherIsStiffer) {
    const std::vector<double>& strain = aorta().y;
    for (std::size_t i = 2; i < strain.size(); ++i)
        EXPECT_LT(strain[i] - strain[i - 1], strain[i - 1] - strain[i - 2]) << aorta().x[i];
}

TEST(AortaReference, TheAssumedAngleOfTheFibresMattersLittle) {
    std::map<std::string, double> along = aorta().constants, across = aorta().constants;
    along["angle_deg"] = 0.0, across["angle_deg"] = 10.0;
    for (std::size_t i = 1; i < aorta().x.size(); ++i) {
        EXPECT_GT(hoop_stress(along, 1.0 + aorta().y[i]), aorta().x[i]);
        EXPECT_LT(hoop_stress(along, 1.0 + aorta().y[i] - 0.0026), aorta().x[i]);
        EXPECT_LT(hoop_stress(across, 1.0 + aorta().y[i]), aorta().x[i]);
        EXPECT_GT(hoop_stress(across, 1.0 + aorta().y[i] + 0.0026), aorta().x[i]);
    }
}

TEST(AortaReference, NamesSourcesThatAreListed) {
    expect_sources(aorta(), 2);
}

TEST(AnnulusReference, IsOneBeatThatClosesWithTheExcursionOfLife) {
    EXPECT_EQ(annulus().columns, "phase,displacement_mm");
    ASSERT_EQ(annulus().x.size(), 41U);
    for (std::size_t i = 0; i < 41; ++i) EXPECT_NEAR(annulus().x[i], double(i) / 40.0, 1e-9);
    EXPECT_DOUBLE_EQ(annulus().y.front(), annulus().y.back());
    const auto [low, high] = std::minmax_element(annulus().y.begin(), annulus().y.end());
    EXPECT_NEAR(*high - *low, 11.6, 1e-9);
    EXPECT_DOUBLE_EQ(annulus().constants.at("excursion_mm"), 11.6);
}

TEST(AnnulusReference, GoesDownStandsReturnsRestsAndEndsWithTheAtriumAtTheStatedTimes) {
    const auto& c = annulus().constants;
    const double top = c.at("excursion_mm"), rest = c.at("atrial_share") * top;
    for (std::size_t i = 0; i + 1 < annulus().x.size(); ++i) {
        const double from = milliseconds(annulus().x[i]), to = milliseconds(annulus().x[i + 1]);
        const double here = annulus().y[i], step = annulus().y[i + 1] - here;
        const auto within = [&](const char* begin, const char* end) { return from >= c.at(begin) && to <= c.at(end); };
        if (to <= c.at("down_begins_ms")) {
            EXPECT_DOUBLE_EQ(here, 0.0) << from;
        } else if (within("down_begins_ms", "down_ends_ms")) {
            EXPECT_GT(step, 0.0) << from;
        } else if (within("down_ends_ms", "return_begins_ms")) {
            EXPECT_NEAR(here, top, 1e-9) << from;
        } else if (within("return_begins_ms", "return_ends_ms")) {
            EXPECT_LT(step, 0.0) << from;
        } else if (within("return_ends_ms", "atrial_begins_ms")) {
            EXPECT_NEAR(here, rest, 2e-3) << from;
        } else if (from >= c.at("atrial_begins_ms")) {
            EXPECT_LT(step, 0.0) << from;
        }
    }
}

TEST(AnnulusReference, TheTimesFollowFromTheirSources) {
    const auto& c = annulus().constants;
    const double rate = c.at("rate_bpm"), beat = 60000.0 / rate;
    EXPECT_NEAR(rate, 3.0 * 60.0 / 2.68, 0.5);
    EXPECT_NEAR(c.at("down_ends_ms"), 540.5 - 2.1 * rate - 40.0, 0.5);
    EXPECT_NEAR(c.at("down_ends_ms") - c.at("down_begins_ms"), 292.0, 0.5);
    EXPECT_NEAR(c.at("return_begins_ms") - c.at("down_ends_ms"), 96.0, 0.5);
    EXPECT_NEAR(c.at("return_ends_ms") - c.at("return_begins_ms"), 2.0 * 96.0, 0.5);
    EXPECT_NEAR(beat - c.at("atrial_begins_ms"), 160.0 + 40.0 - 90.0, 0.5);
    EXPECT_NEAR(c.at("atrial_share"), 110.0 / (1.82 * 192.0 + 110.0), 1e-4);
}

TEST(AnnulusReference, IsHalfWayAtTheMiddleOfEachStage) {
    // Between rows on a straight line, which a half cosine is in its middle.
    const auto at = [](double ms) {
        const double row = 40.0 * ms / milliseconds(1.0), before = std::floor(row);
        return std::lerp(at_phase(before / 40.0), at_phase((before + 1.0) / 40.0), row - before);
    };
    const auto& c = annulus().constants;
    const double top = c.at("excursion_mm"), rest = c.at("atrial_share") * top;
    EXPECT_NEAR(at(0.5 * (c.at("down_begins_ms") + c.at("down_ends_ms"))), 0.5 * top, 0.05);
    EXPECT_NEAR(at(0.5 * (c.at("return_begins_ms") + c.at("return_ends_ms"))), 0.5 * (top + rest), 0.05);
    EXPECT_NEAR(at(0.5 * (c.at("atrial_begins_ms") + milliseconds(1.0))), 0.5 * rest, 0.05);
}

TEST(AnnulusReference, NamesSourcesThatAreListed) {
    expect_sources(annulus(), 8);
}
