// The program as a user meets it: command lines, exit codes, one sentence for each fault, nothing half written.
#include "app/program.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scene/temporary_folder.h"

namespace cathlab {
namespace {

TEST(Program, HelpAndVersionAreNoFaults) {
    EXPECT_EQ(call("--help").code, 0);
    EXPECT_EQ(call("run --help").code, 0);
    const Outcome version = call("--version");
    EXPECT_EQ(version.code, 0);
    EXPECT_NE(version.text.find("cathlab "), std::string::npos);
}

TEST(Program, WrongUseEndsWithTwo) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("a.toml", "schema = 1\n");
    EXPECT_EQ(call("").code, 2);
    EXPECT_EQ(call("ruin").code, 2);
    EXPECT_EQ(call("run").code, 2);
    EXPECT_EQ(call("run " + scene).code, 2);
    EXPECT_EQ(call("run " + scene + " --out x --threads 0").code, 2);
    EXPECT_EQ(call("run " + scene + " --out x --seconds nan").code, 2);
    EXPECT_EQ(call("run " + scene + " --out x --seconds -3").code, 2);
    EXPECT_EQ(call("run " + scene + " --out x --seed -1").code, 2);
    EXPECT_EQ(call("list nonsense").code, 2);
    EXPECT_EQ(call("list channels --log-level loud").code, 2);
    EXPECT_EQ(call("replay").code, 2);
    EXPECT_EQ(call("list channels", "CATHLAB_DATA_DIR=/nonexistent").code, 2);
}

TEST(Program, ListsKnowEveryKind) {
    for (const char* what :
         {"scenes", "devices", "effects", "channels", "materials", "anatomies", "actions", "metrics"}) {
        EXPECT_EQ(call(std::string("list ") + what).code, 0) << what;
        const Outcome json = call(std::string("list ") + what + " --json");
        EXPECT_EQ(json.code, 0) << what;
        EXPECT_EQ(json.text.front(), '[') << what;
    }
    EXPECT_NE(call("list channels").text.find("wire_force_mn"), std::string::npos);
    EXPECT_NE(call("list effects").text.find("respiration"), std::string::npos);
    EXPECT_EQ(call("list effects").text.find("test_force"), std::string::npos);
    EXPECT_EQ(call("list schema").text.front(), '{');
}

TEST(Program, ABadSceneIsOneSentenceAndLeavesNothing) {
    const TemporaryFolder folder;
    const std::string out = folder.path("run");
    const std::string good = "schema = 1\n[anatomy]\nfile = 'adult'\n";
    const std::vector<std::pair<std::string, std::string>> scenes{
        {"", "schema: is missing"},
        {"schema = 1\n[anatomy\n", "a.toml:2: is not valid TOML"},
        {std::string("\0\1\2\3", 4), "not a text file"},
        {std::string((16U << 20U) + 10, '#'), "larger than the 16 MB"},
        {good + "[wall]\nfriction = nan\n", "a.toml:5: [wall] friction: found nan"},
        {good + "[wall]\nfriction = inf\n", "found inf"},
        {good + "[wall]\nfrition = 0.1\n", "did you mean 'friction'?"},
        {good + "[step]\nsubsteps = 'many'\n", "a whole number from 1 to 100"},
        {"schema = 1\n[anatomy]\nmesh = 'none.obj'\n", "no such file 'none.obj'"},
        {"schema = 1\n[anatomy]\nfile = 'adlt'\n", "did you mean 'adult'?"},
    };
    for (const auto& [text, sentence] : scenes) {
        const Outcome run = call("run " + folder.write("a.toml", text) + " --video none --out " + out);
        EXPECT_EQ(run.code, 1) << sentence;
        EXPECT_TRUE(one_sentence(run)) << sentence;
        EXPECT_NE(run.text.find(sentence), std::string::npos) << run.text;
        EXPECT_FALSE(std::filesystem::exists(out));
    }
    const Outcome missing = call("run nowhere.toml --out " + out);
    EXPECT_EQ(missing.code, 1);
    EXPECT_TRUE(one_sentence(missing));
    EXPECT_TRUE(one_sentence(call("check " + folder.path())));
}

TEST(Program, ABadScriptSizeOrFolderIsToldBeforeTheWorldIsBuilt) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("a.toml", "schema = 1\n[anatomy]\nfile = 'adult'\n");
    const std::string out = folder.path("run");
    const Outcome script = call("run " + scene + " --out " + out + " --script " + folder.write("s.csv", "t,a,v\n"));
    EXPECT_EQ(script.code, 1);
    EXPECT_TRUE(one_sentence(script));
    const std::string sized = "run " + scene + " --out " + out + " --size ";
    for (const char* size : {"3x3", "512", "511x512", "axb", "99999x99999", "512x-2"}) {
        const Outcome wrong = call(sized + size);
        EXPECT_EQ(wrong.code, 2) << size;
        EXPECT_TRUE(one_sentence(wrong)) << size;
    }
    const std::string file = folder.write("file", "x");
    EXPECT_TRUE(one_sentence(call("run " + scene + " --out " + file)));
    EXPECT_TRUE(one_sentence(call("run " + scene + " --out " + file + "/below")));
    folder.write("thesis/text.txt", "precious");
    const Outcome foreign = call("run " + scene + " --force --out " + folder.path("thesis"));
    EXPECT_EQ(foreign.code, 1);
    EXPECT_TRUE(one_sentence(foreign));
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(Program, WhatIsNoRunFolderCannotBeReplayed) {
    const TemporaryFolder folder;
    const Outcome none = call("replay " + folder.path() + " --verify");
    EXPECT_EQ(none.code, 1);
    EXPECT_TRUE(one_sentence(none));
    folder.write("manifest.json", "{\"schema\": 1, \"version\":");
    EXPECT_TRUE(one_sentence(call("replay " + folder.path() + " --verify")));
}

TEST(Program, ARunIsReplayedBitForBitAndAnEditedOneIsFoundOut) {
    const TemporaryFolder folder;
    const std::string out = folder.path("run");
    const std::string scene = std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/fork.toml";
    const Outcome run = call("run " + scene + " --seconds 2 --video none --threads 1 --out " + out);
    ASSERT_EQ(run.code, 0) << run.text;
    const Outcome replay = call("replay " + out + " --verify --threads 2");
    EXPECT_EQ(replay.code, 0) << replay.text;

    // One digit of the last line of the trace.
    std::string trace;
    {
        std::ifstream file(out + "/trace.csv", std::ios::binary);
        trace.assign(std::istreambuf_iterator<char>(file), {});
    }
    const std::size_t comma = trace.rfind("\n99,");
    ASSERT_NE(comma, std::string::npos);
    trace[comma + 4] = trace[comma + 4] == '7' ? '3' : '7';
    folder.write("run/trace.csv", trace);
    const Outcome edited = call("replay " + out + " --verify");
    EXPECT_EQ(edited.code, 1) << edited.text;
    EXPECT_NE(edited.text.find("step 99"), std::string::npos) << edited.text;
}

TEST(Program, ABadScriptOrMeshLeavesNoRunFolder) {
    const TemporaryFolder folder;
    const std::string out = folder.path("run");
    const std::string rig = std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/tube_wire.toml";
    const std::string scripted = "run " + rig + " --video none --seconds 1 --out " + out + " --script ";
    for (const char* row :
         {"0,advance,nan", "0,advance,inf", "nan,advance,1", "0,advance,1e9", "0,advanse,1", "-1,advance,1"}) {
        const Outcome run = call(scripted + folder.write("s.csv", std::string("t_s,action,value\n") + row + "\n"));
        EXPECT_EQ(run.code, 1) << row << ": " << run.text;
        EXPECT_TRUE(one_sentence(run)) << row;
        EXPECT_FALSE(std::filesystem::exists(out)) << row;
    }
    const std::string into_out = "run --video none --seconds 1 --out " + out + " ";
    for (const std::string& mesh :
         {std::string(), std::string("\0\1\2\3\4", 5), std::string("solid nothing\nendsolid nothing\n"),
          std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")}) {
        for (const char* name : {"m.obj", "m.stl", "m.ply"}) {
            folder.write(name, mesh);
            const std::string scene =
                folder.write("mesh.toml", std::string("schema = 1\n[anatomy]\nmesh = '") + name + "'\nunit = 'mm'\n");
            const Outcome run = call(into_out + scene);
            EXPECT_EQ(run.code, 1) << name << ": " << run.text;
            EXPECT_EQ(run.text.rfind("terminate", 0), std::string::npos) << run.text;
            EXPECT_NE(run.text.find("cathlab: "), std::string::npos) << run.text;
            EXPECT_FALSE(std::filesystem::exists(out)) << name;
        }
    }
}

std::string bytes_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Program, TheFilmIsTheSameOnAThreadOfItsOwn) {
    const TemporaryFolder folder;
    const std::string scene = std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/fork.toml";
    std::vector<std::string> films;
    const auto small_film = [&](const std::string& threads, const std::string& film) {
        return call("run " + scene + " --seconds 1 --size 256x128 --video " + film + " --threads " + threads +
                    " --out " + folder.path(threads));
    };
    for (const char* threads : {"1", "2", "4"}) {
        const std::string film = folder.path(std::string(threads) + ".avi");
        const Outcome run = small_film(threads, film);
        ASSERT_EQ(run.code, 0) << run.text;
        EXPECT_TRUE(std::filesystem::exists(folder.path(threads) + "/poster.png"));
        films.push_back(bytes_of(film));  // FFV1 loses nothing: equal bytes are equal pictures
    }
    EXPECT_GT(films[0].size(), 10000U);
    EXPECT_TRUE(films[0] == films[1]);
    EXPECT_TRUE(films[0] == films[2]);
}

TEST(Program, AFilmThatCannotBeWrittenIsOneSentence) {
    const TemporaryFolder folder;
    const std::string scene = std::string(CATHLAB_SOURCE_DIR) + "/scenes/rigs/fork.toml";
    const std::string out = folder.path("run");
    const std::string into_out = "run " + scene + " --seconds 2 --out " + out + " --threads ";
    for (const char* threads : {"1", "3"}) {
        const std::string command = into_out + threads;
        const Outcome nowhere = call(command + " --video " + folder.path("none/film.avi"));
        EXPECT_EQ(nowhere.code, 1);
        EXPECT_TRUE(one_sentence(nowhere));
        EXPECT_FALSE(std::filesystem::exists(out));
        // No file may grow beyond 512 KiB, as on a full disk: the film's own thread comes upon it.
        const Outcome full =
            call(command + " --force --video " + folder.path("film.avi"), "trap '' XFSZ; ulimit -f 1024;");
        EXPECT_EQ(full.code, 1) << full.text;
        EXPECT_NE(full.text.find("cathlab: video '"), std::string::npos) << full.text;
        EXPECT_FALSE(std::filesystem::exists(folder.path("film.avi")));
        EXPECT_NE(bytes_of(out + "/manifest.json").find("\"complete\": false"), std::string::npos);
        std::filesystem::remove_all(out);
    }
}

}  // namespace
}  // namespace cathlab
