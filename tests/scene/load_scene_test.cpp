#include "scene/load_scene.h"

#include <gtest/gtest.h>

#include "scene/device_file.h"
#include "scene/json_schema.h"
#include "scene/temporary_folder.h"

namespace cathlab {
namespace {

const std::string wire_file = R"(
schema = 1
kind = "wire"
name = "stiff"
length_mm = 1000
link_length_mm = 5
[[sections]]
diameter_mm = 0.889
bending_stiffness_n_mm2 = 1850
torsion_stiffness_n_mm2 = 1400
axial_stiffness_n = 37000
density_kg_m3 = 7000
material = "stainless_steel"
)";

class LoadScene : public testing::Test {
protected:
    void SetUp() override {
        folder.write("assets/anatomy/adult.toml", "schema = 1\n");
        folder.write("assets/devices/stiff.toml", wire_file);
    }
    SceneSpec load(const std::string& text, const std::vector<std::string>& overlays = {}) {
        return load_scene(folder.write("scenes/a.toml", text), overlays, folder.path());
    }
    std::string error_of(const std::string& text, const std::vector<std::string>& overlays = {}) {
        return error_sentence([&] { load(text, overlays); });
    }
    TemporaryFolder folder;
    const std::string base = "schema = 1\n[anatomy]\nfile = 'adult'\n";
};

TEST_F(LoadScene, ASmallSceneHasTheDefaultsOfThePaper) {
    const SceneSpec s = load(base);
    EXPECT_EQ(s.name, "a");
    EXPECT_EQ(s.anatomy.file, folder.path("assets/anatomy/adult.toml"));
    EXPECT_EQ(s.step.dt_s, 0.02);
    EXPECT_EQ(s.wall.cluster_spacing_mm, 8.0);
    EXPECT_EQ(s.wall.cluster_radius_mm, 12.0);
    EXPECT_EQ(s.wall.cluster_stiffness, 0.8);
    EXPECT_FALSE(s.wire.enabled);
    ASSERT_EQ(s.effects.size(), effect_table().size());
    for (const SceneEffect& effect : s.effects) EXPECT_FALSE(effect.enabled);
}

TEST_F(LoadScene, SectionsFillTheSpec) {
    folder.write("scenes/a.csv", "t_s,action,value\n");
    const SceneSpec s = load(
        "schema = 1\nscript = 'a.csv'\nseed = 7\n[anatomy]\nfile = "
        "'../assets/anatomy/adult.toml'\n[[anatomy.stenosis]]\n"
        "vessel = 'lad'\nplace_mm = 20\ndegree = 0.5\n[wire]\nenabled = true\ndevice = 'stiff'\n[effects.respiration]\n"
        "amplitude_mm = 9\n[c_arm]\nprimary_deg = 40\nisocentre = [1, 2, 3]\n[[wall.region]]\nname = "
        "'arch'\ncluster_stiffness = 0.5\n");
    EXPECT_EQ(s.seed, 7U);
    EXPECT_EQ(s.script, folder.path("scenes/a.csv"));
    EXPECT_EQ(s.anatomy.stenoses.at(0).vessel, "lad");
    EXPECT_EQ(s.wire.device, folder.path("assets/devices/stiff.toml"));
    EXPECT_EQ(s.c_arm.isocentre.point, Vec3(1, 2, 3));
    EXPECT_EQ(s.wall.regions.at(0).cluster_stiffness.value(), 0.5);
    for (const SceneEffect& effect : s.effects) {
        EXPECT_EQ(effect.enabled, effect.info->name == "respiration");
        EXPECT_EQ(effect.values.empty() ? 0.0 : effect.values[0], effect.enabled ? 9.0
                                                                  : effect.values.empty()
                                                                      ? 0.0
                                                                      : effect.info->parameters[0].default_value);
    }
}

TEST_F(LoadScene, AnOverlayIsLaidOverAndNamedInItsErrors) {
    const std::string over =
        folder.write("over.toml", "[wall]\ncluster_stiffness = 0.6\n[effects.respiration]\nenabled = true\n");
    const SceneSpec s = load(base + "[wall]\ncluster_spacing_mm = 9\n", {over});
    EXPECT_EQ(s.wall.cluster_spacing_mm, 9.0);
    EXPECT_EQ(s.wall.cluster_stiffness, 0.6);
    const std::string bad = folder.write("bad.toml", "\n[wall]\ncluster_stifness = 0.6\n");
    EXPECT_NE(error_of(base, {over, bad})
                  .find("bad.toml:3: [wall] cluster_stifness: no such key; did you mean 'cluster_stiffness'?"),
              std::string::npos);
    EXPECT_NE(error_of(base, {folder.path("none.toml")}).find("none.toml: no such file"), std::string::npos);
}

TEST_F(LoadScene, TheHashFollowsTheContentAndNotTheSpelling) {
    const std::uint64_t hash = load(base).hash;
    EXPECT_EQ(load("# comment\nschema = 1\n\n[anatomy]\nfile = \"adult\"\n").hash, hash);
    EXPECT_NE(load(base + "[wall]\nfriction = 0.2\n").hash, hash);
    folder.write("assets/anatomy/adult.toml", "schema = 1 # changed\n");
    EXPECT_NE(load(base).hash, hash);
}

TEST_F(LoadScene, WhatKeysMustSayTogetherIsChecked) {
    EXPECT_NE(error_of("schema = 1\n").find("anatomy: is missing"), std::string::npos);
    EXPECT_NE(error_of("schema = 1\n[anatomy]\n").find("a.toml:2: [anatomy]: needs 'file'"), std::string::npos);
    EXPECT_NE(error_of("schema = 2\n[anatomy]\nfile='adult'").find("a.toml:1: schema: found 2"), std::string::npos);
    EXPECT_NE(error_of(base + "[wire]\nenabled = true\n").find("names no 'device'"), std::string::npos);
    EXPECT_NE(
        error_of(base + "[catheter]\nenabled = true\ndevice = 'stiff'\nfollow = 'wire'\n").find("there is no wire"),
        std::string::npos);
    EXPECT_NE(error_of(base + "[c_arm]\nframe_rate = 14\n").find("7.5, 15 or 30"), std::string::npos);
    EXPECT_NE(error_of(base + "[c_arm]\nsid_mm = 700\n").find("sod_mm"), std::string::npos);
    EXPECT_NE(error_of(base + "[heart]\nprofile = [[0, 1], [0, 2]]\n").find("phases must rise"), std::string::npos);
    EXPECT_NE(error_of(base + "[video]\nwidth = 301\n").find("must be even"), std::string::npos);
    EXPECT_NE(error_of(base + "[effects.respirtion]\n").find("did you mean 'respiration'?"), std::string::npos);
    EXPECT_EQ(error_of(base + "[effects.respirtion]\n").find("test_"), std::string::npos) << "they are for tests alone";
    EXPECT_NO_THROW(load(base + "[effects.test_force]\n"));
    EXPECT_NE(error_of(base + "[effects.respiration]\nperiod_s = 0\n").find("[effects.respiration] period_s: found 0"),
              std::string::npos);
    EXPECT_NE(error_of(base + "[effects.stiffening]\n").find("[wall] form = \"elastic\" is wanted"), std::string::npos);
    EXPECT_NO_THROW(load(base + "[effects.stiffening]\n[wall]\nform = 'elastic'\n"));
    EXPECT_NE(error_of(base + "[wall]\nform = 'elastc'\n").find("elastic"), std::string::npos);
    EXPECT_NE(error_of("schema = 1\n[anatomy]\nmesh = 'x.obj'\n").find("no such file 'x.obj'"), std::string::npos);
    folder.write("scenes/x.obj", "");
    EXPECT_NE(error_of("schema = 1\n[anatomy]\nmesh = 'x.obj'\n").find("[[anatomy.entry]]"), std::string::npos);
}

TEST_F(LoadScene, AMissingDeviceNamesThoseThatExist) {
    const std::string error = error_of(base + "[wire]\nenabled = true\ndevice = 'stif'\n");
    EXPECT_NE(error.find("a.toml:6: [wire] device: no 'stif' in assets/devices; did you mean 'stiff'? There is: stiff"),
              std::string::npos)
        << error;
}

TEST_F(LoadScene, EmptyAndBrokenScenesAreRefusedWithOneSentence) {
    EXPECT_NE(error_of("").find("schema: is missing"), std::string::npos);
    EXPECT_NE(error_of(base + "[wall\n").find("is not valid TOML"), std::string::npos);
    EXPECT_NE(error_of("anatomy = 3\nschema = 1").find("a section [anatomy] is wanted"), std::string::npos);
    EXPECT_NE(error_of("schema = 1\nanatomy = [{file='adult'}]").find("a section [anatomy] is wanted"),
              std::string::npos);
}

TEST_F(LoadScene, ScenesAreFoundByName) {
    load(base);
    EXPECT_EQ(find_scene("a", folder.path()), folder.path("scenes/a.toml"));
    EXPECT_EQ(find_scene("scenes/a.toml", folder.path()), folder.path("scenes/a.toml"));
    EXPECT_NE(error_sentence([&] { find_scene("b", folder.path()); }).find("no scene 'b'"), std::string::npos);
}

TEST_F(LoadScene, DeviceFilesFillTheSpecsOfTheirRooms) {
    const std::string path = folder.path("assets/devices/stiff.toml");
    EXPECT_EQ(device_kind(path), "wire");
    EXPECT_EQ(load_wire(path).sections.at(0).bending_stiffness_n_mm2, 1850.0);
    EXPECT_NE(error_sentence([&] { load_catheter(path); }).find("the device is a wire; a catheter is wanted"),
              std::string::npos);
    const std::string catheter =
        folder.write("c.toml",
                     "schema = 1\nkind = 'catheter'\nname = 'c'\n[[segments]]\nname = 'only'\nlength_mm = 20\n"
                     "max_bend_deg = 90\nmax_rate_deg_s = 90\n");
    EXPECT_EQ(load_catheter(catheter).segments.size(), 1U);
    EXPECT_NE(error_sentence([&] { device_kind(folder.write("k.toml", "kind = 'wir'")); }).find("did you mean 'wire'?"),
              std::string::npos);
    EXPECT_NE(error_sentence([&] {
                  load_wire(folder.write("n.toml", wire_file + "diameter_mm = 3\n"));
              }).find("not valid TOML"),
              std::string::npos);
    EXPECT_THROW(load_wire(folder.write("e.toml", "")), UserError);
    std::string no_such_material = wire_file;
    no_such_material.replace(no_such_material.find("stainless_steel"), 15, "stainles_steel");
    EXPECT_NE(error_sentence([&] {
                  load_wire(folder.write("m.toml", no_such_material));
              }).find("did you mean 'stainless_steel'?"),
              std::string::npos);
}

TEST(Devices, EveryDeviceOfTheProjectIsValid) {
    const std::string folder = std::string(CATHLAB_SOURCE_DIR) + "/assets/devices/";
    for (const std::string& name : names_in_folder(folder, ".toml")) {
        const std::string path = folder + name + ".toml";
        if (device_kind(path) == "wire")
            EXPECT_NO_THROW(load_wire(path)) << path;
        else if (device_kind(path) == "passive_catheter")
            EXPECT_NO_THROW(load_sleeve(path)) << path;
        else
            EXPECT_NO_THROW(load_catheter(path)) << path;
    }
}

TEST(Scenes, EverySceneOfTheProjectIsValid) {
    const std::string root = CATHLAB_SOURCE_DIR;
    for (const std::string& name : names_in_folder(root + "/scenes", ".toml")) {
        const std::string path = root + "/scenes/" + name + ".toml";
        try {
            load_scene(path, {}, root);
        } catch (const UserError& error) {
            const bool no_data = std::string(error.what()).find("shared/data") != std::string::npos;
            EXPECT_TRUE(no_data) << error.what();  // meshes of patients are not part of the project
        }
    }
}

TEST(JsonSchema, TheFilesInDocsAreUpToDate) {
    const std::string docs = std::string(CATHLAB_SOURCE_DIR) + "/docs/";
    EXPECT_EQ(read_text_file(docs + "scene.schema.json", 1U << 20U), scene_schema_json())
        << "write it anew: cathlab list schema > docs/scene.schema.json";
    EXPECT_EQ(read_text_file(docs + "device.schema.json", 1U << 20U), device_schema_json())
        << "write it anew: cathlab list device-schema > docs/device.schema.json";
}

}  // namespace
}  // namespace cathlab
