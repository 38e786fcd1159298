#include "explain/dataset.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "explain/folder.h"
#include "explain/rig.h"
#include "explain/split.h"

using namespace cathlab;
using explain_test::Folder;
using explain_test::heart_toml;

namespace {

std::string rows(int n, const std::string& cells) {
    std::string out;
    for (int i = 0; i < n; ++i) out += "0," + std::to_string(0.1 * i) + "," + cells + "\n";
    return out;
}

/// What read_dataset says to these two files.
std::string complaint(const std::string& toml, const std::string& csv) {
    const Folder folder(toml, csv);
    try {
        read_dataset(folder.path());
    } catch (const UserError& e) {
        return e.what();
    }
    return "nothing";
}

void expect_says(const std::string& toml, const std::string& csv, const std::string& part) {
    const std::string said = complaint(toml, csv);
    EXPECT_NE(said.find(part), std::string::npos) << "said: " << said << "\nexpected: " << part;
}

const std::string good_header = "run,t_s,displacement_mm\n";

}  // namespace

TEST(Dataset, IsReadWithItsUnitsRolesRunsAndLabels) {
    const Folder folder(heart_toml("[[0.0, 0.8], [0.0, 0.9]]"),
                        "run,t_s,displacement_m,belt_au,temperature,who\n"
                        "a,0,0.001,1,20.5,x\na,0.1,0.002,2,,x\na,0.2,,3,20,x\na,0.3,0.004,4,20,x\n"
                        "b,0,0.001,1,20.5,y\nb,0.1,0.002,2,,y\nb,0.2,0.003,3,20,y\nb,0.3,0.004,4,20,y\n");
    const Dataset data = read_dataset(folder.path());
    EXPECT_EQ(data.kind, "heart-motion");
    EXPECT_EQ(data.rows(), 8U);
    EXPECT_EQ(data.run_names, (std::vector<std::string>{"a", "b"}));
    const DataColumn* moved = data.find("displacement");
    ASSERT_NE(moved, nullptr);
    EXPECT_EQ(moved->role, ColumnRole::measured);
    EXPECT_EQ(moved->unit, "mm");
    EXPECT_DOUBLE_EQ(moved->values[1], 2.0);
    EXPECT_TRUE(std::isnan(moved->values[2]));
    EXPECT_EQ(data.find("belt")->role, ColumnRole::extra);
    EXPECT_EQ(data.find("belt")->unit, "au");
    EXPECT_TRUE(std::isnan(data.find("temperature")->values[1]));
    ASSERT_EQ(data.labels.size(), 1U);
    EXPECT_EQ(data.labels[0].values[4], "y");
    ASSERT_TRUE(data.heart.axis.has_value());
    EXPECT_NEAR(data.heart.axis->norm(), 1.0, 1e-15);
}

TEST(Dataset, ABadTableIsNamedByFileLineAndColumn) {
    const std::string toml = heart_toml("[]");
    expect_says(toml, good_header + rows(8, "1.0") + "0,9,abc\n", "data.csv:10: column displacement_mm: found 'abc'");
    expect_says(toml, good_header + rows(8, "1.0") + "0,9,nan\n", "found 'nan'");
    expect_says(toml, good_header + rows(8, "1.0") + "0,9,1e999\n", "found '1e999'");
    expect_says(toml, good_header + rows(8, "1.0") + "0,0.2,1\n", "data.csv:10: column t_s: time does not rise");
    expect_says(toml, good_header + rows(8, "1.0") + "0,1.5\n", "data.csv:10: has 2 cells; the header has 3");
    expect_says(toml, good_header + rows(1, "1.0"), "has 1 rows");
    expect_says(toml, "", "is empty");
    expect_says(toml, "run,t_s,displacement_mm,t_s\n" + rows(8, "1.0,1"), "stands twice");
    expect_says(toml, "run,displacement_mm\n0,1\n0,1\n0,1\n0,1\n0,1\n0,1\n0,1\n0,1\n", "column t_s is missing");
    expect_says(toml, "run,t_s,displacement_kpa\n" + rows(8, "1.0"), "needs the measured columns 'displacement' in mm");
    expect_says(toml, "run,t_s,displacement_mm,part\n" + rows(8, "1.0,test"), "train or val is wanted");
    expect_says(toml, "run,t_s,displacement_mm,part\n" + rows(8, "1.0,train"), "both train and val are wanted");
}

TEST(Dataset, ATableMayHaveCommentsAndAMarkAndIsStillCountedByItsLines) {
    const std::string toml = heart_toml("[]"), comment = "\xEF\xBB\xBF# from the rig, 25 C\r\n";
    const Folder folder(toml, comment + good_header + "# first run\n" + rows(8, "+1.0"));
    EXPECT_EQ(read_dataset(folder.path()).rows(), 8U);
    expect_says(toml, comment + good_header + rows(8, "1.0") + "0,9,0x1p3\n", "data.csv:11: column displacement_mm");
    expect_says(toml, comment + "run,displacement_mm\n" + "0,1\n0,1\n0,1\n0,1\n0,1\n0,1\n0,1\n0,1\n",
                "data.csv:2: the column t_s");
}

TEST(Dataset, NothingThatATerminalObeysLeavesATableInASentence) {
    const std::string toml = heart_toml("[]");
    expect_says(toml, good_header + rows(8, "1.0") + "0,9,\x1b[2J" + std::string(1000, 'x') + "\n", "found '?[2Jx");
    expect_says(toml, "run,t_s,\x1b]0;x\n" + rows(8, "1.0"), "found run, t_s, ?]0;x");
    EXPECT_LT(complaint(toml, "run,t_s," + std::string(1U << 20U, 'x') + "\n" + rows(8, "1.0")).size(), 1000U);
    std::string many = "t_s";
    for (int i = 0; i < 1000; ++i) many += ",c" + std::to_string(i);
    expect_says(toml, many + "\n", "names more than 1000 columns");
}

TEST(Dataset, ABadDescriptionIsNamedByFileLineAndKey) {
    const std::string csv = good_header + rows(8, "1.0");
    std::string toml = heart_toml("[]");
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string out = toml;
        out.replace(out.find(from), from.size(), to);
        return out;
    };
    expect_says(with("heart-motion", "hart-motion"), csv, "did you mean 'heart-motion'");
    expect_says(with("title", "titel"), csv, "dataset.toml:3: titel: no such key; did you mean 'title'?");
    expect_says(with("sensor_noise = 0.1", "sensor_noise = -1.0"), csv, "0 or more is wanted");
    expect_says(with("sensor_noise = 0.1", "sensor_noise = \"low\""), csv, "sensor_noise");
    expect_says(with("format = 1", "format = 2"), csv, "1 is wanted");
    expect_says(with("license = \"l\"", ""), csv, "license: is missing");
    expect_says(with("axis = [0.0, 0.0, 2.0]", "axis = [0.0, 0.0, 0.0]"), csv, "no direction");
    expect_says(heart_toml("[[0.0, 0.5], [0.0]]"), csv, "found 2 lists for 1 runs");
    expect_says(heart_toml("[[0.5, 0.5]]"), csv, "beats must rise");
    EXPECT_THROW(read_dataset("/no/such/folder"), UserError);
}

TEST(Dataset, AContactsRigIsReadAndItsFaultsAreNamed) {
    const std::string head =
        "format = 1\nkind = \"wall-contact\"\ntitle = \"t\"\nsource = \"s\"\nlicense = \"l\"\n"
        "declared_effects = []\nsensor_noise = 0.0\n[setup]\n";
    const std::string setup =
        "tube = { radius_mm = 12.0, length_mm = 200.0, thickness_mm = 1.5 }\ntool_radius_mm = 2.5\n"
        "sensor_rest_mm = [[13.5, 0.0, 90.0]]\n"
        "material = { law = \"neo-hooke\", young_modulus_kpa = 1200.0, poisson = 0.49 }\ndensity_kg_m3 = 1100.0\n"
        "[[setup.fixed]]\nname = \"start\"\ncenter_mm = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 2.0]\n"
        "radius_mm = 14.5\nhalf_thickness_mm = 0.1\n";
    const std::string csv = "run,t_s,tool_x_mm,tool_y_mm,tool_z_mm,sensor_x_mm,sensor_y_mm,sensor_z_mm,force_n\n" +
                            rows(9, "9,0,90,13,0,90,1");
    const Folder folder(head + setup, csv);
    const WallContactSetup rig = read_dataset(folder.path()).contact;
    EXPECT_EQ(rig.tube_radius_mm, 12.0);
    EXPECT_EQ(rig.thickness_mm, 1.5);
    EXPECT_EQ(rig.sensor_rest_mm.at(0), Vec3(13.5, 0.0, 90.0));
    EXPECT_EQ(rig.held.at(0).normal, Vec3::UnitZ());
    EXPECT_EQ(rig.young_modulus_kpa, 1200.0);

    const auto with = [&](const std::string& from, const std::string& to) {
        std::string out = setup;
        out.replace(out.find(from), from.size(), to);
        return head + out;
    };
    expect_says(with("tube = {", "tub = {"), csv, "did you mean 'tube'");
    expect_says(with("radius_mm = 12.0", "radius_mm = -12.0"), csv, "above 0 is wanted");
    expect_says(with("neo-hooke", "neo-hoke"), csv, "did you mean 'neo-hooke'");
    expect_says(with("poisson = 0.49", "poisson = 0.5"), csv, "0 to 0.4999 is wanted");
    expect_says(with("[[13.5, 0.0, 90.0]]", "[[13.5, 0.0]]"), csv, "three numbers are wanted");
    expect_says(with("[[13.5, 0.0, 90.0]]", "[]"), csv, "found 0 places for 1 runs");
    expect_says(with("normal = [0.0, 0.0, 2.0]", "normal = [0.0, 0.0, 0.0]"), csv, "no direction");
    expect_says(with("tube = { radius_mm = 12.0, length_mm = 200.0, thickness_mm = 1.5 }\n", ""), csv, "mesh");
}

TEST(Dataset, EveryRunShowsItselfInBothPartsOfTheSplit) {
    std::string csv = good_header;
    for (int run = 0; run < 3; ++run)
        for (int i = 0; i < 90; ++i) csv += std::to_string(run) + "," + std::to_string(0.1 * i) + ",1\n";
    const Folder folder(heart_toml("[]"), csv);
    const Dataset data = read_dataset(folder.path());
    const Split split = split_rows(data);
    for (Index run = 0; run < 3; ++run) {
        int held = 0, all = 0;
        for (std::size_t i = 0; i < data.rows(); ++i)
            if (data.run[i] == run) held += split.held_out[i], ++all;
        EXPECT_NEAR(static_cast<double>(held) / all, 1.0 / 3.0, 0.05);
    }
}

TEST(Dataset, EveryFolderOfTheSharedDataIsRead) {
    namespace fs = std::filesystem;
    const fs::path root = CATHLAB_SHARED_DATA;
    if (!fs::exists(root)) GTEST_SKIP() << "the shared data are not here: " << root;
    int count = 0;
    for (const char* shelf : {"measured", "blind", "fem"})
        for (const auto& entry : fs::directory_iterator(root / shelf)) {
            if (!fs::exists(entry.path() / "dataset.toml")) continue;
            EXPECT_NO_THROW({
                const Dataset data = read_dataset(entry.path().string());
                EXPECT_FALSE(data.of_role(ColumnRole::measured).empty());
            }) << entry.path();
            ++count;
        }
    EXPECT_GE(count, 19);
}

TEST(Dataset, AMillionRowsAreReadAndRefusedByTheRigInASentence) {
    std::string csv = "run,t_s,displacement_mm\n";
    csv.reserve(24U << 20U);
    for (int i = 0; i < 1000000; ++i) csv += "0," + std::to_string(i) + ",1.5\n";
    const Folder folder(heart_toml("[]"), csv);
    const Dataset data = read_dataset(folder.path());
    EXPECT_EQ(data.rows(), 1000000U);
    const Split split = split_rows(data);
    try {
        make_rig(data, split);
        FAIL() << "a million rows were taken";
    } catch (const UserError& e) {
        EXPECT_NE(std::string(e.what()).find("1000000 rows; at most 100000"), std::string::npos) << e.what();
    }
}
