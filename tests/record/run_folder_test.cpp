#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/errors.h"
#include "record/run_reader.h"
#include "record/run_writer.h"
#include "scene/temporary_folder.h"
#include "scene/toml_document.h"

namespace cathlab {
namespace {

World::StateHash hash_of(std::uint64_t seed) {
    return {seed * 7919, {{"vessel", seed * 31}, {"wire", seed * 37 + 1}}};
}

Input input_of(std::int64_t step) {
    Input input;
    input.advance = step < 40 ? 30.0 : -1.0 / 3.0;
    input.distal_bend = static_cast<double>(step) * 0.1;
    return input;
}

Channels channels_of(std::int64_t step) {
    Channels c;
    c.time_s = 0.02 * static_cast<double>(step + 1);
    c.wire_force_mn = std::sqrt(static_cast<double>(step));
    c.force_bar = step == 3 ? std::numeric_limits<double>::quiet_NaN() : -0.0;
    return c;
}

class RunFolder : public testing::Test {
protected:
    RunManifest manifest() const {
        RunManifest m;
        m.version = "0.1.0";
        m.scene = "scenes/a \"quoted\".toml";
        m.overlays = {"x.toml"};
        m.scene_hash = 0xFEDCBA9876543210ULL;
        m.seed = 9007199254740991ULL;
        m.dt_s = 0.02;
        m.threads = 3;
        return m;
    }
    std::string record(std::int64_t steps = 120, bool complete = true) {
        const std::string out = folder.path("run");
        std::filesystem::remove_all(out);
        prepare_run_folder(out, false);
        RunWriter writer(out, manifest(), {"vessel", "wire"});
        for (std::int64_t k = 0; k < steps; ++k) {
            if (RunWriter::wants_hash(k)) writer.hash(k, hash_of(static_cast<std::uint64_t>(k)));
            writer.input(k, input_of(k));
            writer.step(
                k, channels_of(k),
                k == 5 ? std::vector<Event>{{5, 0.1, "refused", "wire", "line\nbreak", 0.25}} : std::vector<Event>{});
        }
        writer.hash(steps, hash_of(static_cast<std::uint64_t>(steps)));
        writer.finish(steps, complete, 1.5, "");
        return out;
    }
    std::string edit(const std::string& name, const std::string& from, const std::string& to) {
        const std::string path = folder.path("run/" + name);
        std::string text = read_text_file(path, 1U << 24U);
        const auto at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        if (at != std::string::npos) text.replace(at, from.size(), to);
        folder.write("run/" + name, text);
        return error_sentence([&] {
            read_run(folder.path("run"));
            read_trace(folder.path("run"), true);
        });
    }
    void cut(const std::string& name, std::size_t bytes) {
        const std::string path = folder.path("run/" + name);
        const std::string text = read_text_file(path, 1U << 24U);
        folder.write("run/" + name, text.substr(0, text.size() - bytes));
    }
    std::string read_error() {
        return error_sentence([&] { read_run(folder.path("run")); });
    }
    TemporaryFolder folder;
};

TEST_F(RunFolder, WhatIsWrittenIsReadBackToTheSameBits) {
    const RunRecord run = read_run(record());
    EXPECT_TRUE(run.manifest.complete);
    EXPECT_EQ(run.manifest.scene, manifest().scene);
    EXPECT_EQ(run.manifest.scene_hash, manifest().scene_hash);
    EXPECT_EQ(run.manifest.seed, manifest().seed);
    EXPECT_EQ(run.steps, 120);
    for (std::int64_t k = 0; k < 120; ++k)
        for (const ActionInfo& action : action_table())
            EXPECT_EQ(run.input_at(k).*action.value, input_of(k).*action.value) << k << action.name;
    ASSERT_EQ(run.hashes.size(), 4U);
    EXPECT_EQ(run.hashes[1].steps, 50);
    EXPECT_EQ(first_difference(run.hashes[1].hash, hash_of(50)), "");
    EXPECT_EQ(first_difference(run.hashes[1].hash, hash_of(51)), "vessel");
    const auto trace = read_trace(run.folder, true);
    ASSERT_EQ(trace.size(), 120U);
    for (std::size_t k = 0; k < trace.size(); ++k)
        EXPECT_EQ(first_difference(trace[k], channels_of(static_cast<std::int64_t>(k))), nullptr) << k;
    EXPECT_EQ(first_difference(trace[1], channels_of(2))->name, "time_s");
}

TEST_F(RunFolder, AnUnchangedInputTakesNoLine) {
    const std::string out = folder.path("run");
    prepare_run_folder(out, false);
    RunWriter writer(out, manifest(), {});
    for (std::int64_t k = 0; k < 10; ++k) writer.input(k, k < 5 ? input_of(1) : input_of(2));
    writer.hash(10, {});
    writer.finish(10, true, 0, "");
    EXPECT_EQ(read_run(out).inputs.size(), 2U);
    EXPECT_EQ(read_lines(out + "/inputs.jsonl", true).size(), 3U);
}

TEST_F(RunFolder, ACommandOutOfRangeIsKeptAsTheStepTakesItAndCanBeReadBack) {
    const std::string out = folder.path("run");
    prepare_run_folder(out, false);
    RunWriter writer(out, manifest(), {});
    Input wanted;
    wanted.advance = 1e6;
    wanted.distal_bend = std::numeric_limits<double>::quiet_NaN();
    writer.input(0, wanted);
    writer.hash(1, {});
    writer.finish(1, true, 0, "");
    const Input kept = read_run(out).input_at(0);
    EXPECT_EQ(kept.advance, in_range(wanted).advance);
    EXPECT_EQ(kept.distal_bend, find_action("distal_bend")->default_value);
}

TEST_F(RunFolder, AStoppedRunIsMarkedIncompleteAndCanBeReplayed) {
    const RunRecord run = read_run(record(70, false));
    EXPECT_FALSE(run.manifest.complete);
    EXPECT_EQ(run.steps, 70);
}

TEST_F(RunFolder, ACrashedRunIsReadUpToItsLastWholeLine) {
    record(120, false);
    cut("inputs.jsonl", std::string("{\"end\":120}\n").size() + 20);
    cut("hashes.csv", 5);
    const RunRecord run = read_run(folder.path("run"));
    EXPECT_EQ(run.hashes.size(), 3U);
    EXPECT_EQ(run.steps, 119);
}

TEST_F(RunFolder, TruncatedFilesOfAFinishedRunAreRefused) {
    for (const std::string name : {"inputs.jsonl", "hashes.csv", "manifest.json"}) {
        for (const std::size_t bytes : {std::size_t{1}, std::size_t{7}, std::size_t{60}}) {
            record();
            cut(name, bytes);
            if (name == "manifest.json" && bytes == 1) continue;  // only the last line's end: still whole JSON
            EXPECT_NE(read_error().find(name), std::string::npos) << name << bytes << read_error();
        }
    }
    record();
    folder.write("run/hashes.csv", "");
    EXPECT_NE(read_error().find("hashes.csv: is empty"), std::string::npos);
    record();
    folder.write("run/inputs.jsonl", "");
    EXPECT_NE(read_error().find("inputs.jsonl"), std::string::npos);
}

TEST_F(RunFolder, EditedFilesAreRefusedWithTheirLine) {
    record();
    EXPECT_NE(edit("inputs.jsonl", "\"advance\":30.0", "\"advance\":\"x\"")
                  .find("inputs.jsonl:1: advance: has the wrong type"),
              std::string::npos);
    record();
    EXPECT_NE(edit("inputs.jsonl", "\"advance\":30.0", "\"advance\":3000").find("inputs.jsonl:1: advance: found 3000"),
              std::string::npos);
    record();
    EXPECT_NE(edit("inputs.jsonl", "\"advance\"", "\"advanse\"").find("inputs.jsonl:1: advance: is missing"),
              std::string::npos);
    record();
    EXPECT_NE(edit("inputs.jsonl", "{\"step\":7", "{\"step\":4").find("inputs.jsonl:8: step 4 is out of order"),
              std::string::npos);
    record();
    EXPECT_NE(edit("inputs.jsonl", "{\"step\":7", "{\"stop\":7").find("inputs.jsonl:8: step: is missing"),
              std::string::npos);
    record();
    EXPECT_NE(edit("inputs.jsonl", "{\"step\":7", "\"step\":7").find("inputs.jsonl:8: is not valid JSON"),
              std::string::npos);
    record();
    EXPECT_NE(edit("hashes.csv", "step,whole", "step,hole").find("hashes.csv:1"), std::string::npos);
    record();
    EXPECT_NE(edit("hashes.csv", "\n50,", "\nfifty,").find("hashes.csv:3"), std::string::npos);
    record();
    EXPECT_NE(edit("manifest.json", "\"dt_s\": 0.02", "\"dt_s\": null").find("manifest.json: dt_s: has the wrong type"),
              std::string::npos);
    record();
    EXPECT_NE(edit("manifest.json", "\"dt_s\"", "\"dt\"").find("manifest.json: dt_s: is missing"), std::string::npos);
    record();
    EXPECT_NE(edit("manifest.json", "\"schema\": 1", "\"schema\": 2").find("this program reads 1"), std::string::npos);
    record();
    EXPECT_NE(edit("trace.csv", "\n5,", "\n6,").find("trace.csv:7"), std::string::npos);
    record();
    EXPECT_NE(edit("trace.csv", "wire_force_mn [mN]", "wire_force_n [N]").find("trace.csv:1"), std::string::npos);
    record();
    folder.write("run/manifest.json", std::string(5000, '['));
    EXPECT_NE(read_error().find("nests too deep"), std::string::npos);
    folder.write("run/manifest.json", std::string("\0\1\2", 3));
    EXPECT_NE(read_error().find("not a text file"), std::string::npos);
}

TEST_F(RunFolder, EventsAreOneObjectALine) {
    record();
    const auto lines = read_lines(folder.path("run/events.jsonl"), true);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0],
              R"({"step":5,"time_s":0.1,"kind":"refused","entity":"wire","message":"line\nbreak","value":0.25})");
}

TEST_F(RunFolder, AForeignFolderIsNeverTouched) {
    folder.write("mine/thesis.txt", "precious");
    EXPECT_NE(error_sentence([&] { prepare_run_folder(folder.path("mine"), true); }).find("holds no earlier run"),
              std::string::npos);
    EXPECT_EQ(read_text_file(folder.path("mine/thesis.txt"), 100), "precious");
    folder.write("mine/manifest.json", "{\"name\": \"another program's\"}");
    EXPECT_THROW(prepare_run_folder(folder.path("mine"), true), UserError);
    EXPECT_NE(error_sentence([&] { prepare_run_folder(folder.path("mine/thesis.txt"), true); }).find("is a file"),
              std::string::npos);
}

TEST_F(RunFolder, AnEarlierRunIsReplacedOnRequestAlone) {
    record();
    folder.write("run/notes.txt", "kept");
    EXPECT_NE(error_sentence([&] { prepare_run_folder(folder.path("run"), false); }).find("--force"),
              std::string::npos);
    EXPECT_NO_THROW(read_run(folder.path("run")));
    prepare_run_folder(folder.path("run"), true);
    EXPECT_FALSE(std::filesystem::exists(folder.path("run/manifest.json")));
    EXPECT_TRUE(std::filesystem::exists(folder.path("run/notes.txt")));
}

TEST_F(RunFolder, AFullDiskIsNamed) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "/dev/full is not there";
    LineFile file("/dev/full");
    EXPECT_NE(error_sentence([&] {
                  file.add("x");
                  file.close();
              }).find("No space left"),
              std::string::npos);
    EXPECT_NE(error_sentence([&] { write_whole_file(folder.path("none/x.json"), "{}"); }).find("cannot be written"),
              std::string::npos);
}

}  // namespace
}  // namespace cathlab
