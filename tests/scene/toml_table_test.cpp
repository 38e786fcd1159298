#include "scene/toml_table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace cathlab {
namespace {

struct Vessel {
    std::string name;
    double length_mm = 10;
    std::optional<double> radius_mm;
    std::vector<std::array<double, 3>> points;
    SourcePlace where;
};
constexpr Parameter parameters[] = {{"amplitude_mm", "mm", 3.0, 0.0, 20.0, "amplitude"}};
struct File {
    int schema = 0;
    std::string kind = "tree";
    bool closed = true;
    Vec3 origin = Vec3::Zero();
    NameOrPoint isocentre;
    std::vector<Vessel> vessels;
    std::vector<double> values = parameter_defaults(parameters);
};

Table<File> file_table() {
    const auto vessel = Table<Vessel>("one vessel")
                            .text("name", &Vessel::name, "name")
                            .required()
                            .number("length_mm", &Vessel::length_mm, "mm", {1, 500}, "length")
                            .number("radius_mm", &Vessel::radius_mm, "mm", {0.1, 20}, "radius")
                            .rows("points_mm", &Vessel::points, "mm", {-1000, 1000}, {2, 500}, "centre-line")
                            .place(&Vessel::where);
    return Table<File>("a file")
        .integer("schema", &File::schema, "1", {1, 1}, "version")
        .required()
        .choice("kind", &File::kind, {"tree", "mesh"}, "kind")
        .boolean("closed", &File::closed, "closed")
        .vec3("origin_mm", &File::origin, "mm", {-100, 100}, "origin")
        .name_or_point("isocentre", &File::isocentre, {-1000, 1000}, "isocentre")
        .tables("vessel", &File::vessels, vessel)
        .parameters(parameters, &File::values);
}

File read(const std::string& text) {
    return read_table(parse_toml(text, "a.toml"), file_table());
}

std::string error_of(const std::string& text) {
    try {
        read(text);
    } catch (const UserError& error) {
        return error.what();
    }
    return "no error";
}

TEST(TomlTable, FillsAStructAndKeepsDefaults) {
    const File f = read(
        "schema = 1\nkind = 'mesh'\norigin_mm = [1, 2.5, 3]\nisocentre = 'arch'\namplitude_mm = 4\n"
        "[[vessel]]\nname = 'aorta'\npoints_mm = [[0, 0, 0], [1, 2, 3]]\n[[vessel]]\nname = 'iliac'\nradius_mm = 4\n");
    EXPECT_EQ(f.kind, "mesh");
    EXPECT_TRUE(f.closed);
    EXPECT_EQ(f.origin, Vec3(1, 2.5, 3));
    EXPECT_EQ(f.isocentre.name, "arch");
    ASSERT_EQ(f.vessels.size(), 2U);
    EXPECT_DOUBLE_EQ(f.vessels[0].length_mm, 10);
    EXPECT_FALSE(f.vessels[0].radius_mm);
    EXPECT_DOUBLE_EQ(f.vessels[0].points[1][2], 3);
    EXPECT_DOUBLE_EQ(f.vessels[1].radius_mm.value(), 4);
    EXPECT_EQ(f.vessels[1].where.line, 9);
    EXPECT_DOUBLE_EQ(f.values.at(0), 4);
}

TEST(TomlTable, AnUnknownKeyNamesItsLineAndTheNearestKey) {
    const std::string error = error_of("schema = 1\n[[vessel]]\nname = 'a'\nlenght_mm = 3\n");
    EXPECT_NE(error.find("a.toml:4: [vessel 1] lenght_mm: no such key; did you mean 'length_mm'?"), std::string::npos)
        << error;
}

TEST(TomlTable, AValueOutOfRangeSaysWhatIsAllowed) {
    const std::string error = error_of("schema = 1\n\n[[vessel]]\nname = 'a'\nlength_mm = -3.5\n");
    EXPECT_EQ(error, "a.toml:5: [vessel 1] length_mm: found -3.5; a number from 1 to 500 mm is wanted");
}

TEST(TomlTable, NotANumberAndInfinityAreRefused) {
    EXPECT_NE(error_of("schema = 1\namplitude_mm = nan").find("found nan"), std::string::npos);
    EXPECT_NE(error_of("schema = 1\namplitude_mm = inf").find("found inf"), std::string::npos);
    EXPECT_NE(error_of("schema = 1\norigin_mm = [0, nan, 0]").find("a.toml:2"), std::string::npos);
}

TEST(TomlTable, AWrongTypeIsNamed) {
    EXPECT_EQ(error_of("schema = 1\nclosed = 1"), "a.toml:2: closed: found 1; true or false is wanted");
    EXPECT_NE(error_of("schema = '1'").find("found the text '1'; a whole number"), std::string::npos);
    EXPECT_NE(error_of("schema = 1.0").find("a whole number"), std::string::npos);
    EXPECT_NE(error_of("schema = 1\nvessel = 3").find("sections [[vessel]]"), std::string::npos);
    EXPECT_NE(error_of("schema = 1\nvessel = [3]").find("sections [[vessel]]"), std::string::npos);
    EXPECT_NE(error_of("schema = 1\nkind = 2020-01-01").find("the date or time 2020-01-01"), std::string::npos);
    EXPECT_NE(error_of("schema = 1\nisocentre = [1, 2]").find("three numbers"), std::string::npos);
    EXPECT_NE(error_of("schema = 1\n[[vessel]]\nname='a'\npoints_mm = [[1,2,3],[1,2]]").find("rows of 3"),
              std::string::npos);
}

TEST(TomlTable, AMissingKeyIsNamed) {
    EXPECT_NE(error_of("kind = 'tree'").find("schema: is missing"), std::string::npos);
    EXPECT_NE(error_of("schema = 1\n[[vessel]]\n").find("[vessel 1] name: is missing"), std::string::npos);
}

TEST(TomlTable, AChoiceSuggestsTheNearest) {
    EXPECT_NE(error_of("schema = 1\nkind = 'mseh'").find("one of tree, mesh is wanted; did you mean 'mesh'?"),
              std::string::npos);
}

TEST(TomlDocument, BrokenTextNamesTheLine) {
    EXPECT_NE(error_of("schema = 1\nkind = ").find("a.toml:2: is not valid TOML"), std::string::npos);
    EXPECT_NE(error_of("schema = 1\nschema = 1").find("a.toml:2: is not valid TOML"), std::string::npos);
    EXPECT_NE(error_of("schema = 1\n\xff\xfe").find("is not valid TOML"), std::string::npos);
    EXPECT_NE(error_of("x = " + std::string(100000, '[')).find("is not valid TOML"), std::string::npos);
    std::string dots = "a";
    for (int i = 0; i < 100000; ++i) dots += ".a";
    EXPECT_NE(error_of(dots + " = 1").find("more than 64 dotted parts"), std::string::npos);
}

TEST(TomlDocument, AnOverlayMergesTablesAndReplacesLists) {
    TomlNode base = parse_toml("a = 1\nlist = [1, 2]\n[s]\nx = 1\ny = 2\n", "base.toml");
    merge_toml(base, parse_toml("list = [3]\n\n[s]\ny = 'bad'\n[t]\nz = 1\n", "over.toml"));
    EXPECT_EQ(canonical_text(base), canonical_text(parse_toml("a=1\nlist=[3]\n[t]\nz=1.0\n[s]\ny='bad'\nx=1\n", "c")));
    const TomlNode* y = base.find("s")->find("y");
    EXPECT_EQ(*y->file, "over.toml");
    EXPECT_EQ(y->line, 4);
    EXPECT_EQ(*base.find("s")->find("x")->file, "base.toml");
}

TEST(TomlDocument, MissingFolderBinaryAndHugeFilesAreRefused) {
    const auto folder =
        std::filesystem::temp_directory_path() / ("cathlab_toml_document_test_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    EXPECT_THROW(load_toml((folder / "missing.toml").string()), UserError);
    EXPECT_THROW(load_toml(folder.string()), UserError);
    std::ofstream(folder / "binary.toml") << std::string("a = 1\n\0\1\2", 9);
    EXPECT_THROW(load_toml((folder / "binary.toml").string()), UserError);
    std::ofstream(folder / "huge.toml") << std::string((16U << 20U) + 1, '#');
    EXPECT_THROW(load_toml((folder / "huge.toml").string()), UserError);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace cathlab
