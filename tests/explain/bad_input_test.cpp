// Recordings of every kind that hold too little, or what the kind's rig cannot be: an error of one sentence, or an
// answer that names nothing and holds no number that is none.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <sstream>

#include "core/errors.h"
#include "core/random.h"
#include "explain/folder.h"
#include "explain/tracer.h"

using namespace cathlab;
using explain_test::Folder;

namespace {

struct Kind {
    std::string name, setup, inputs, measured;
    std::string unit;  ///< another one, of something else
};

const std::vector<Kind>& kinds() {
    static const std::vector<Kind> all{
        {"catheter-tip",
         "proximal_length_mm = 25\nmiddle_length_mm = 4\ndistal_length_mm = 30\ntip_length_mm = 2\n"
         "base_position_mm = [0, 0, 0]\nbase_axis = [0, 0, 1]\nbend_plane_axis = [1, 0, 0]\n",
         "insertion_mm,rotation_deg,proximal_bend_deg,distal_bend_deg", "tip_x_mm,tip_y_mm,tip_z_mm", "tip_x_kpa"},
        {"tendon-tip",
         "tendon_radius_mm = 4\n[[setup.segment]]\nname = \"one\"\nlength_mm = 60\n"
         "tendons = [\"a_mm\", \"b_mm\", \"c_mm\"]\n",
         "a_mm,b_mm,c_mm", "tip_x_mm,tip_y_mm,tip_z_mm", "tip_x_kpa"},
        {"heart-motion", "beat_times_s = []\naxis = [0, 0, 1]\n", "", "displacement_mm", "displacement_kpa"},
        {"wall-tension", "specimen = \"strip\"\nthickness_mm = 1.0\nmode = \"tension\"\n", "stress_kpa", "strain",
         "strain_mm"},
        {"wall-contact",
         "tube = { radius_mm = 10.0, length_mm = 60.0, thickness_mm = 1.0 }\ntool_radius_mm = 2.0\n"
         "sensor_rest_mm = [[11.0, 0.0, 30.0]]\ndensity_kg_m3 = 1000.0\n"
         "material = { law = \"neo-hooke\", young_modulus_kpa = 500.0, poisson = 0.49 }\n"
         "[[setup.fixed]]\nname = \"start\"\ncenter_mm = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 1.0]\n"
         "radius_mm = 12.0\nhalf_thickness_mm = 0.1\n",
         "tool_x_mm,tool_y_mm,tool_z_mm", "sensor_x_mm,sensor_y_mm,sensor_z_mm", "sensor_x_kpa"}};
    return all;
}

std::size_t count(const std::string& list) {
    return list.empty() ? 0 : 1 + static_cast<std::size_t>(std::count(list.begin(), list.end(), ','));
}

std::string header(const Kind& kind) {
    return "run,t_s" + (kind.inputs.empty() ? "" : "," + kind.inputs) + "," + kind.measured + "\n";
}

/// Rows of cells: the value of cell c in row i.
std::string table(const Kind& kind, int rows, const std::function<std::string(int i, std::size_t c)>& cell) {
    std::string out = header(kind);
    const std::size_t cells = count(kind.inputs) + count(kind.measured);
    for (int i = 0; i < rows; ++i) {
        out += "0," + std::to_string(0.5 * i);
        for (std::size_t c = 0; c < cells; ++c) out += "," + cell(i, c);
        out += "\n";
    }
    return out;
}

std::string toml(const Kind& kind) {
    return "format = 1\nkind = \"" + kind.name +
           "\"\ntitle = \"t\"\nsource = \"s\"\nlicense = \"l\"\ndeclared_effects = []\nsensor_noise = 0.05\n[setup]\n" +
           kind.setup;
}

/// An error in a sentence, or an answer of which every number is one and which names no effect.
void expect_honest(const Kind& kind, const std::string& csv, const std::string& what) {
    const Folder folder(toml(kind), csv);
    ExplainOptions options;
    options.max_effects = 1;
    options.threads = 3;
    try {
        const Explanation found = explain(read_dataset(folder.path()), options);
        EXPECT_TRUE(found.effects.empty()) << kind.name << ", " << what << ": " << found.effects[0].name;
        EXPECT_TRUE(std::isfinite(found.held_out_before) && std::isfinite(found.held_out_after))
            << kind.name << ", " << what;
    } catch (const UserError& e) {
        EXPECT_GT(std::string(e.what()).size(), 20U) << kind.name << ", " << what;
    }
}

void expect_refused(const Kind& kind, const std::string& csv, const std::string& part) {
    const Folder folder(toml(kind), csv);
    try {
        explain(read_dataset(folder.path()));
        FAIL() << kind.name << " was taken; wanted: " << part;
    } catch (const UserError& e) {
        EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << kind.name << ": " << e.what();
    }
}

std::string usual(int i, std::size_t c) {
    return std::to_string(1.0 + 0.1 * std::sin(0.3 * i + static_cast<double>(c)));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    return text;
}

}  // namespace

TEST(BadInput, ATableOfAnyKindThatIsWrongIsRefusedByItsLineOrColumn) {
    for (const Kind& kind : kinds()) {
        const std::string good = table(kind, 30, usual);
        const std::string first = kind.measured.substr(0, kind.measured.find(','));
        expect_refused(kind, replaced(good, first, "something_else"), first.substr(0, first.find('_')));
        expect_refused(kind, replaced(good, first, kind.unit), "needs the measured columns");
        const auto spoilt = [&](const std::string& with) {
            return table(kind, 30, [&](int i, std::size_t c) { return i == 9 && c == 0 ? with : usual(i, c); });
        };
        expect_refused(kind, spoilt("high"), "data.csv:11");
        expect_refused(kind, spoilt("nan"), "data.csv:11");
        expect_refused(kind, spoilt("inf"), "data.csv:11");
        expect_refused(kind, replaced(good, "\n0,5.000000,", "\n0,1.000000,"), "time does not rise");
        expect_refused(kind, table(kind, 1, usual), "has 1 rows");
        if (kind.inputs.empty()) continue;
        const std::string input = kind.inputs.substr(0, kind.inputs.find(','));
        expect_refused(kind, replaced(good, input + ",", "other_au,"), input.substr(0, input.find('_')));
    }
}

TEST(BadInput, InputsThatStandStillAndColumnsOfZerosGiveAnHonestAnswer) {
    for (const Kind& kind : kinds()) {
        const std::size_t inputs = count(kind.inputs);
        expect_honest(kind, table(kind, 60, [](int, std::size_t) { return std::string("1.0"); }), "all constant");
        expect_honest(kind, table(kind, 60, [](int, std::size_t) { return std::string("0"); }), "all zero");
        expect_honest(
            kind, table(kind, 60, [&](int i, std::size_t c) { return c < inputs ? usual(i, c) : std::string("0"); }),
            "zeros measured");
    }
}

TEST(BadInput, NoiseThatNoRigMakesIsGivenNoName) {
    for (const Kind& kind : kinds()) {
        if (kind.name == "wall-contact") continue;  // minutes; its noise is that of the others' judge
        const std::size_t inputs = count(kind.inputs);
        expect_honest(kind,
                      table(kind, 120,
                            [&](int i, std::size_t c) {
                                return c < inputs ? usual(i, c)
                                                  : std::to_string(random_normal(5, RandomStream::sampling,
                                                                                 static_cast<std::uint64_t>(i), c));
                            }),
                      "noise alone");
    }
}
