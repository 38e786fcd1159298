// cathlab calibrate from outside: what it leaves, what it refuses, and how it is stopped.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "program.h"
#include "scene/temporary_folder.h"

namespace cathlab {
namespace {

const std::string& fork_scene() {
    static const std::string path = std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/fork.toml";
    return path;
}

std::string curve(const TemporaryFolder& folder) {
    return folder.write("curve.csv", "stress_kpa,strain\n0,0\n20,0.05\n40,0.09\n60,0.12\n");
}

std::string beat(const TemporaryFolder& folder) {
    return folder.write("beat.csv",
                        "phase,displacement_mm\n0,0\n0.1,1\n0.2,4\n0.3,6.5\n0.4,8\n0.5,8\n0.6,5\n0.7,2\n0.8,1\n");
}

std::string quick(const TemporaryFolder& folder) {
    return " --particles 3 --generations 1 --threads 2 --out " + folder.path("overlay.toml");
}

std::string text_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t files_in(const std::string& folder) {
    std::size_t n = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        n += entry.is_regular_file() ? 1U : 0U;
    return n;
}

TEST(Calibrate, ContactsWantOneDataSetOfTheirKindAndNoReference) {
    const TemporaryFolder folder;
    EXPECT_EQ(call("calibrate wall").code, 2);
    EXPECT_EQ(call("calibrate wall " + curve(folder) + " --contact " + folder.path("")).code, 2);
    const Outcome missing = call("calibrate wall --contact " + folder.path("nowhere"));
    EXPECT_EQ(missing.code, 1);
    EXPECT_NE(missing.text.find("is no folder"), std::string::npos) << missing.text;
    const std::string fem = std::string(CATHLAB_SHARED_DATA) + "/fem/tube";
    if (!std::filesystem::exists(fem)) GTEST_SKIP() << "the shared data are not here: " << fem;
    const std::string tension = std::string(CATHLAB_SHARED_DATA) + "/measured/silicone-ef30-0t";
    const Outcome other = call("calibrate wall --contact " + tension);
    EXPECT_EQ(other.code, 1);
    EXPECT_NE(other.text.find("wall-contact"), std::string::npos) << other.text;
}

TEST(Calibrate, TheWallLeavesAnOverlayThatASceneTakesAndAReport) {
    const TemporaryFolder folder;
    const std::string report = folder.path("new/report");
    const Outcome done = call("calibrate wall " + curve(folder) + quick(folder) + " --polish 2 --report " + report);
    ASSERT_EQ(done.code, 0) << done.text;
    EXPECT_NE(done.text.find("RMSE"), std::string::npos);
    EXPECT_NE(text_of(folder.path("overlay.toml")).find("[wall]\ncluster_spacing_mm"), std::string::npos);
    const std::string page = text_of(report + "/report.html");
    EXPECT_NE(page.find("calibrate wall"), std::string::npos);
    EXPECT_NE(page.find("first guess"), std::string::npos);
    EXPECT_EQ(page.find("<script"), std::string::npos);
    EXPECT_EQ(files_in(folder.path()), 3U);  // with the reference
    EXPECT_EQ(call("check " + fork_scene() + " --overlay " + folder.path("overlay.toml")).code, 0);
    // A second calibration may take the first one's place.
    EXPECT_EQ(
        call("calibrate wall " + curve(folder) + quick(folder) + " --polish 2 --stress paper --report " + report).code,
        0);
}

TEST(Calibrate, TheWallIsFittedOnAnyRigThatASceneDescribes) {
    const TemporaryFolder folder;
    for (const char* rig : {"ring", "strip", "block"}) {
        const Outcome done = call("calibrate wall " + curve(folder) + quick(folder) + " --polish 0 --rig " +
                                  CATHLAB_SOURCE_DIR + "/scenes/rigs/" + rig + ".toml --report " + folder.path(rig));
        ASSERT_EQ(done.code, 0) << done.text;
        EXPECT_NE(text_of(folder.path(rig) + "/report.html").find(std::string("a ") + rig), std::string::npos);
    }
    const std::string tube = std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/stress_strain-anatomy.toml";
    const std::string stations =
        folder.write("stations.toml", "schema = 1\n[anatomy]\nfile = \"" + tube +
                                          "\"\n[[rig.station]]\nname = \"middle\"\nregion = \"tube\"\n");
    const Outcome done = call("calibrate wall " + curve(folder) + quick(folder) + " --polish 0 --rig " + stations);
    ASSERT_EQ(done.code, 0) << done.text;
    EXPECT_NE(done.text.find("Strain at the stations"), std::string::npos) << done.text;
    EXPECT_NE(done.text.find("middle"), std::string::npos) << done.text;
}

TEST(Calibrate, TheHeartLeavesAnOverlayThatASceneRunsWith) {
    const TemporaryFolder folder;
    const Outcome done =
        call("calibrate heart " + beat(folder) + " --scene " + fork_scene() + " --beats 1" + quick(folder));
    ASSERT_EQ(done.code, 0) << done.text;
    EXPECT_NE(done.text.find("rest pose of the vessels: phase 0.45"), std::string::npos) << done.text;
    const Outcome run = call("run " + fork_scene() + " --overlay " + folder.path("overlay.toml") +
                             " --seconds 0.5 --video none --out " + folder.path("run"));
    EXPECT_EQ(run.code, 0) << run.text;
}

TEST(Calibrate, WhatIsWrongIsOneSentenceAndLeavesNothing) {
    const TemporaryFolder folder;
    const std::string fine = curve(folder);
    const std::string other = folder.write("thesis.toml", "[chapter]\n");
    const auto refused = [&](const std::string& arguments, int code, const std::string& sentence) {
        const Outcome done = call("calibrate " + arguments);
        EXPECT_EQ(done.code, code) << arguments << ": " << done.text;
        EXPECT_TRUE(one_sentence(done)) << arguments;
        EXPECT_NE(done.text.find(sentence), std::string::npos) << arguments << ": " << done.text;
    };
    refused("wall nowhere.csv" + quick(folder), 1, "nowhere.csv");
    refused("wall " + beat(folder) + quick(folder), 1, "no column for the stress");
    refused("wall " + folder.write("turn.csv", "stress_kpa,strain\n0,0\n2,0.1\n1,0.2\n") + quick(folder), 1,
            "turns round");
    refused("wall " + fine + quick(folder) + " --free wall.cluster_stiffness=0.9:0.4", 2, "turned round");
    refused("wall " + fine + quick(folder) + " --free wall.cluster_stiffness=0.4:nan", 2, "two numbers");
    refused("wall " + fine + quick(folder) + " --free wall.cluster_stiffnes=0.4:0.9", 2, "did you mean");
    refused("wall " + fine + quick(folder) + " --free wall.friction=0.1:0.9", 1, "does not change a wall");
    refused("wall " + fine + quick(folder) + " --free wall.cluster_radius_mm=0.5:1", 1, "radius");
    refused("wall " + fine + quick(folder) + " --range 100:200", 1, "at least 3");
    refused("wall " + fine + quick(folder) + " --range 100", 2, "LOW:HIGH");
    refused("wall " + fine + quick(folder) + " --omega nan", 2, "finite");
    refused("wall " + fine + quick(folder) + " --scene nowhere", 1, "no scene");
    refused("wall " + fine + quick(folder) + " --rig nowhere", 1, "no scene");
    const std::string pressed = folder.write("pressed.csv", "stress_kpa,strain\n-1,-0.1\n-2,-0.2\n-3,-0.3\n");
    refused("wall " + pressed + quick(folder), 1, "pressed.csv:2");
    refused("wall " + pressed + quick(folder), 1, "block.toml");
    const std::string rigs = std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/";
    refused("wall " + fine + quick(folder) + " --stress paper --rig " + rigs + "strip.toml", 1, "round wall");
    const auto rig_file = [&](const std::string& rig) {
        return folder.write("rig.toml", "schema = 1\n[anatomy]\nfile = \"" + rigs +
                                            "stress_strain-anatomy.toml\"\n[rig]\nkind = \"stations\"\n" + rig);
    };
    refused("wall " + fine + quick(folder) + " --rig " + rig_file("[[rig.station]]\nname = \"a\"\nregion = \"tub\"\n"),
            1, "did you mean 'tube'");
    refused("wall " + fine + quick(folder) + " --rig " +
                rig_file("[[rig.station]]\nname = \"a\"\nregion = \"tube\"\nplace_mm = 3.0\n"),
            1, "rig.toml:6");
    refused("wall " + fine + " --out " + other, 1, "not written by a calibration");
    refused("wall " + fine + " --out " + folder.path("none/o.toml"), 1, "there is no folder");
    refused("wall " + fine + " --out " + folder.path(), 1, "is a folder");
    refused("wall " + fine + quick(folder) + " --report " + other, 1, "is a file");
    refused("heart " + fine + quick(folder), 1, "no column for the phase");
    refused("heart " + beat(folder) + quick(folder) + " --scene " + std::string(CATHLAB_SOURCE_DIR) +
                "/scenes/rigs/tube_wire.toml",
            1, "no heart");
    for (const char* arguments :
         {"calibrate", "calibrate wall", "calibrate liver x.csv", "calibrate wall x.csv --stress wild",
          "calibrate wall x.csv --particles 1", "calibrate heart x.csv --knots 2",
          "calibrate heart x.csv --positive up", "calibrate wall x.csv --threads 0"})
        EXPECT_EQ(call(arguments).code, 2) << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder.path("overlay.toml")));
    EXPECT_EQ(text_of(other), "[chapter]\n");
}

TEST(Calibrate, CtrlCKeepsTheBestFound) {
    const TemporaryFolder folder;
    // The signal comes as soon as something was found; the swarm would go on for hours.
    const std::string said = folder.path("said");
    const Outcome done =
        call("calibrate wall " + curve(folder) + " --particles 4 --generations 100000 --threads 2 --out " +
             folder.path("overlay.toml") + " 2>" + said + " & p=$!; while kill -0 $p && ! grep -q 'so far' " + said +
             "; do sleep 0.1; done; kill -INT $p; wait $p");
    EXPECT_EQ(done.code, 1) << done.text;
    EXPECT_NE(text_of(said).find("stopped; what is written is the best found"), std::string::npos) << text_of(said);
    EXPECT_NE(text_of(folder.path("overlay.toml")).find("[wall]"), std::string::npos);
    EXPECT_EQ(files_in(folder.path()), 3U);  // with the reference and what was said
}

}  // namespace
}  // namespace cathlab
