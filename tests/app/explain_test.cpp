// cathlab explain from outside: what it finds runs in a scene, and what is wrong leaves nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <sstream>

#include "program.h"
#include "scene/temporary_folder.h"

namespace cathlab {
namespace {

std::string described(const std::string& kind, const std::string& setup) {
    return "format = 1\nkind = \"" + kind +
           "\"\ntitle = \"t\"\nsource = \"s\"\nlicense = \"l\"\ndeclared_effects = []\nsensor_noise = 0.0\n[setup]\n" +
           setup;
}

/// A place that breathes by 5 mm in 3.6 s and does nothing else.
std::string breathing() {
    std::ostringstream csv;
    csv << "run,t_s,displacement_mm\n";
    for (int i = 0; i < 400; ++i) {
        const double t = 0.1 * i;
        csv << i / 200 << "," << t << "," << -5.0 * std::pow(std::sin(3.14159265 * (t / 3.6 + 0.1)), 4) << "\n";
    }
    return csv.str();
}

TEST(Explain, WhatItFindsRunsInAScene) {
    const TemporaryFolder folder;
    folder.write("data/dataset.toml", described("heart-motion", "beat_times_s = []\naxis = [0, 0, 1]\n"));
    folder.write("data/data.csv", breathing());
    const Outcome found =
        call("explain " + folder.path("data") + " --threads 2 --max-effects 1 --out " + folder.path("out"));
    ASSERT_EQ(found.code, 0) << found.text;
    EXPECT_NE(found.text.find("respiration"), std::string::npos) << found.text;
    for (const char* file : {"out/result.json", "out/report.html", "out/overlay.toml"})
        EXPECT_TRUE(std::filesystem::exists(folder.path(file))) << file;
    const Outcome run =
        call("run " + std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/fork.toml --overlay " +
             folder.path("out/overlay.toml") + " --seconds 0.2 --video none --out " + folder.path("run"));
    EXPECT_EQ(run.code, 0) << run.text;
}

TEST(Explain, AFolderThatIsWrongIsOneSentenceAndLeavesNothing) {
    const TemporaryFolder folder;
    const std::string fine = described("heart-motion", "beat_times_s = []\naxis = [0, 0, 1]\n");
    const auto refused = [&](const std::string& toml, const std::string& csv, const std::string& part) {
        folder.write("data/dataset.toml", toml);
        folder.write("data/data.csv", csv);
        const Outcome done = call("explain " + folder.path("data") + " --out " + folder.path("out"));
        EXPECT_EQ(done.code, 1) << done.text;
        EXPECT_TRUE(one_sentence(done));
        EXPECT_NE(done.text.find(part), std::string::npos) << done.text;
        EXPECT_FALSE(std::filesystem::exists(folder.path("out"))) << part;
    };
    const std::string head = "run,t_s,displacement_mm\n";
    std::string rows;
    for (int i = 0; i < 30; ++i) rows += "0," + std::to_string(i) + ",1.5\n";
    std::string nothing = "run,t_s\n";
    for (int i = 0; i < 30; ++i) nothing += "0," + std::to_string(i) + "\n";
    refused(fine, nothing, "displacement");
    refused(fine, "run,t_s,displacement_kpa\n" + rows, "in mm");
    refused(fine, head + rows + "0,31,high\n", "data.csv:32");
    refused(fine, head + rows + "0,31,nan\n", "data.csv:32");
    refused(fine, head + rows + "0,3,1.5\n", "time does not rise");
    refused(fine, head + "0,1,1.5\n", "1 rows");
    // A rig that the data are not of.
    refused(described("tendon-tip", "tendon_radius_mm = 4\n"), head + rows, "segment");
    refused(described("wall-tension", "specimen = \"s\"\nthickness_mm = 2.0\nmode = \"tension\"\n"), head + rows,
            "stress");
}

TEST(Explain, ASignalToEndLeavesNothingHalfWritten) {
    const TemporaryFolder folder;
    std::ostringstream csv;  // more rows than are explained within a second
    csv << "run,t_s,displacement_mm\n";
    for (int i = 0; i < 3000; ++i)
        csv << i / 1500 << "," << 0.04 * i << "," << std::sin(0.01 * i) + 0.3 * std::cos(0.37 * i * (1 + i % 7))
            << "\n";
    folder.write("data/dataset.toml", described("heart-motion", "beat_times_s = []\naxis = [0, 0, 1]\n"));
    folder.write("data/data.csv", csv.str());
    const Outcome done = call("explain " + folder.path("data") + " --threads 2 --out " + folder.path("out") + " 2>" +
                              folder.path("said") + " & p=$!; sleep 1; kill -TERM $p; wait $p");
    EXPECT_NE(done.code, 0) << done.text;
    EXPECT_FALSE(std::filesystem::exists(folder.path("out")));
}

}  // namespace
}  // namespace cathlab
