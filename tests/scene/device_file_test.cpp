// Device files that somebody spoiled: each is refused with a sentence that names the file and the key.
#include "scene/device_file.h"

#include <gtest/gtest.h>

#include "scene/temporary_folder.h"

namespace cathlab {
namespace {

const std::string wire_text = R"(schema = 1
kind = "wire"
name = "w"
length_mm = 1000.0
link_length_mm = 5.0
friction = 0.1
max_push_n = 5.0
max_speed_mm_s = 100.0
[[sections]]
length_mm = 30.0
diameter_mm = 0.889
bending_stiffness_n_mm2 = 5.0
torsion_stiffness_n_mm2 = 4.0
axial_stiffness_n = 3000.0
density_kg_m3 = 7000.0
rest_curvature_per_mm = 0.1
link_length_mm = 2.0
material = "stainless_steel"
[[sections]]
length_mm = 970.0
diameter_mm = 0.889
bending_stiffness_n_mm2 = 1850.0
torsion_stiffness_n_mm2 = 1400.0
axial_stiffness_n = 37000.0
density_kg_m3 = 7000.0
material = "stainless_steel"
)";

const std::string catheter_text = R"(schema = 1
kind = "catheter"
name = "c"
length_mm = 900.0
outer_diameter_mm = 2.0
inner_diameter_mm = 1.0
link_length_mm = 5.0
tip_length_mm = 3.0
tip_marker_length_mm = 2.0
max_speed_mm_s = 100.0
max_rotation_deg_s = 360.0
[[segments]]
name = "only"
length_mm = 25.0
max_bend_deg = 60.0
max_rate_deg_s = 60.0
)";

std::string passive_text() {
    std::string text = wire_text;
    text.replace(text.find("\"wire\""), 6, "\"passive_catheter\"");
    text.replace(text.find("friction = 0.1"), 14, "friction = 0.1\nwire_friction = 0.1\ninner_diameter_mm = 0.6");
    return text;
}

struct Spoiled {
    std::string from, to, named;  // the first `from` is replaced; the sentence must hold `named`
};

template <class Load>
void expect_refused(const std::string& text, const std::vector<Spoiled>& cases, const Load& load) {
    const TemporaryFolder folder;
    ASSERT_NO_THROW(load(folder.write("good.toml", text)));
    for (const Spoiled& spoiled : cases) {
        std::string bad = text;
        const std::size_t at = bad.find(spoiled.from);
        ASSERT_NE(at, std::string::npos) << spoiled.from;
        bad.replace(at, spoiled.from.size(), spoiled.to);
        const std::string said = error_sentence([&] { load(folder.write("bad.toml", bad)); });
        EXPECT_NE(said.find("bad.toml"), std::string::npos) << spoiled.to << ": " << said;
        EXPECT_NE(said.find(spoiled.named), std::string::npos) << spoiled.to << ": " << said;
        EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    }
}

/// Every number with every absurd value.
std::vector<Spoiled> absurd_numbers(const std::string& text) {
    std::vector<Spoiled> cases;
    std::size_t begin = 0;
    while (begin < text.size()) {
        const std::size_t end = text.find('\n', begin);
        const std::string line = text.substr(begin, end - begin);
        begin = end + 1;
        const std::size_t equals = line.find(" = ");
        if (equals == std::string::npos || line.find('"') != std::string::npos) continue;
        const std::string key = line.substr(0, equals);
        for (const char* value : {"nan", "inf", "-inf", "-1.0", "1e300", "'much'", "[1.0]", "true"}) {
            if (key == "rest_curvature_per_mm" && std::string(value) == "-1.0") continue;
            cases.push_back({line, key + " = " + value, key});
        }
    }
    return cases;
}

TEST(SpoiledDeviceFile, AWiresAbsurdNumbersAreNamed) {
    expect_refused(wire_text, absurd_numbers(wire_text), load_wire);
}

TEST(SpoiledDeviceFile, ACathetersAbsurdNumbersAreNamed) {
    expect_refused(catheter_text, absurd_numbers(catheter_text), load_catheter);
    expect_refused(passive_text(), absurd_numbers(passive_text()), load_sleeve);
}

TEST(SpoiledDeviceFile, AWireThatCannotBeIsRefused) {
    expect_refused(wire_text,
                   {{"bending_stiffness_n_mm2 = 5.0", "bending_stiffness_n_mm2 = 0.0", "bending_stiffness_n_mm2"},
                    {"torsion_stiffness_n_mm2 = 4.0", "torsion_stiffness_n_mm2 = 0", "torsion_stiffness_n_mm2"},
                    {"axial_stiffness_n = 3000.0", "", "axial_stiffness_n"},
                    {"diameter_mm = 0.889", "diameter_mm = 0.0", "diameter_mm"},
                    {"length_mm = 30.0", "length_mm = 0.0", "sections[0].length_mm"},
                    {"length_mm = 30.0", "length_mm = 999.9", "leaves nothing for the last"},
                    {"link_length_mm = 5.0", "link_length_mm = 0.0", "link_length_mm"},
                    {"link_length_mm = 5.0", "link_length_mm = 0.2", "4000 are allowed"},
                    {"link_length_mm = 5.0", "link_length_mm = 400.0", "link_length_mm"},
                    {"friction = 0.1", "fricton = 0.1", "friction"},
                    {"schema = 1", "schema = 2", "schema"},
                    {"kind = \"wire\"", "kind = \"wires\"", "did you mean 'wire'"},
                    {"kind = \"wire\"", "kind = \"catheter\"", "a wire is wanted"},
                    {"kind = \"wire\"\n", "", "kind"},
                    {"stainless_steel", "stainless_stele", "did you mean 'stainless_steel'"},
                    {wire_text.substr(wire_text.find("[[sections]]")), "", "sections"}},
                   load_wire);
}

TEST(SpoiledDeviceFile, ACatheterThatCannotBeIsRefused) {
    expect_refused(catheter_text,
                   {{"inner_diameter_mm = 1.0", "inner_diameter_mm = 2.5", "inner_diameter_mm"},
                    {"max_bend_deg = 60.0", "max_bend_deg = 200.0", "max_bend_deg"},
                    {"max_rate_deg_s = 60.0", "max_rate_deg_s = 0.0", "max_rate_deg_s"},
                    {"length_mm = 900.0", "length_mm = 20.0", "length_mm"},
                    {"tip_marker_length_mm = 2.0", "tip_marker_length_mm = 4.0", "tip_marker_length_mm"},
                    {catheter_text.substr(catheter_text.find("[[segments]]")), "segments = []\n", "segments"}},
                   load_catheter);
    expect_refused(passive_text(),
                   {{"inner_diameter_mm = 0.6", "inner_diameter_mm = 0.9", "inner_diameter_mm"},
                    {"inner_diameter_mm = 0.6", "", "inner_diameter_mm"},
                    {"length_mm = 30.0", "length_mm = 0.0", "sections[0].length_mm"}},
                   load_sleeve);
}

}  // namespace
}  // namespace cathlab
