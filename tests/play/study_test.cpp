// Trials of a study in the trainer, the questions after them, and the expert beside a result.
#include <algorithm>
#include <cstdlib>

#include "app/program.h"
#include "play/play_bench.h"
#include "study/protocol.h"
#include "study/questionnaire.h"
#include "study/run_index.h"

namespace cathlab::play {
namespace {

namespace fs = std::filesystem;

class StudyAtTheTrainer : public PlayBench {
protected:
    std::string study;

    void SetUp() override {
        PlayBench::SetUp();
        study = folder.path("study");
        Protocol protocol;
        protocol.name = "trial";
        protocol.groups = {"novice"};
        protocol.tasks = {"wide", "wait"};
        protocol.trials = 1;
        write_study(study, protocol);
        add_participant(study, protocol, {"P01", "novice", false});
        add_participant(study, protocol, {"S01", "novice", true});
    }
    void sit_down(const std::string& who = "P01") {
        app.reset();
        SDL_SetHint(SDL_HINT_VIDEODRIVER, "dummy");
        PlayOptions wanted = options();
        wanted.scene.clear();
        wanted.study = study;
        wanted.participant = who;
        app = std::make_unique<PlayApp>(wanted, context);
        app->settings().view.largest_picture = 128;
        app->settings().run.folder = folder.path("elsewhere");
        app->settings().run.record = false;  // a trial is kept nevertheless
        frames(3);
    }
    void begin_trial() {
        tap(SDL_SCANCODE_RETURN);
        ASSERT_TRUE(leave(Screen::study, 5));
        ASSERT_TRUE(leave(Screen::loading, 5));
        ASSERT_TRUE(app->screen() == Screen::play);
    }
    void push_to_the_end() {
        key(SDL_SCANCODE_W, true);
        for (int i = 0; i < 500 && app->screen() == Screen::play; ++i) {
            frames(1);
            if (app->simulation() != nullptr && status().goal.inside) key(SDL_SCANCODE_W, false);
        }
        key(SDL_SCANCODE_W, false);
        ASSERT_TRUE(app->screen() == Screen::result);
        frames(3);
    }
};

TEST_F(StudyAtTheTrainer, ATrialIsKeptWithItsAnswersAndTheNextOneFollows) {
    sit_down();
    ASSERT_TRUE(app->screen() == Screen::study);
    begin_trial();
    ASSERT_EQ(app->simulation()->status().goal.present, true);
    tap(SDL_SCANCODE_EQUALS);  // no faster, no other go
    EXPECT_EQ(status().time_scale, 1.0);
    const auto steps = status().steps;
    tap(SDL_SCANCODE_BACKSPACE);
    EXPECT_GT(status().steps, steps);
    push_to_the_end();
    const std::string run = app->result().folder;
    EXPECT_EQ(fs::path(run).filename(), "wide-1");
    EXPECT_FALSE(fs::exists(run + ".part"));
    tap(SDL_SCANCODE_RETURN);
    ASSERT_TRUE(app->screen() == Screen::questions);
    frames(2);
    tap(SDL_SCANCODE_RETURN);  // the first answer of the first statement has the focus
    EXPECT_EQ(read_questionnaire(run + "/questionnaire.json").sheets[0][0], 1);
    app->questions().answers.sheets[2][5] = 45;
    app->questions().changed = true;
    frames(1);
    EXPECT_EQ(read_questionnaire(run + "/questionnaire.json").given(), 2U);
    const RunEntry entry = read_run_folder(study, "runs/P01/wide-1");
    EXPECT_EQ(entry.participant, "P01");
    EXPECT_EQ(entry.task, "wide");
    EXPECT_EQ(entry.trial, 1);
    const Outcome score = call("score " + run, "CATHLAB_DATA_DIR=" + context.data_root);
    EXPECT_EQ(score.code, 0) << score.text;
    // Whoever leaves in the middle of the questions loses none of them, and goes on with the next trial.
    sit_down();
    ASSERT_TRUE(app->screen() == Screen::study);
    EXPECT_EQ(read_questionnaire(run + "/questionnaire.json").given(), 2U);
    begin_trial();
    EXPECT_EQ(app->setup().task, "wait");
    EXPECT_TRUE(app->side() == Side::kept);  // this task forbids the inner view
    tap(SDL_SCANCODE_V);
    EXPECT_TRUE(app->side() == Side::kept);
}

TEST_F(StudyAtTheTrainer, ATrialThatIsLeftDoesNotCountAndComesAgain) {
    sit_down();
    begin_trial();
    frames(20);
    app.reset();
    EXPECT_FALSE(fs::exists(study + "/runs/P01/wide-1"));
    sit_down();
    begin_trial();
    EXPECT_EQ(app->setup().task, "wide");
    EXPECT_LT(status().steps, 20);
}

TEST_F(StudyAtTheTrainer, WhoTakesNoPartOrIsNoPersonGetsASentence) {
    EXPECT_NE(error_sentence([&] { sit_down("P02"); }).find("P01"), std::string::npos);
    EXPECT_NE(error_sentence([&] { sit_down("S01"); }).find("synthetic"), std::string::npos);
    study = folder.path("nothing");
    EXPECT_NE(error_sentence([&] { sit_down(); }).find("study.json"), std::string::npos);
    const std::string environment = "SDL_VIDEODRIVER=dummy CATHLAB_DATA_DIR=" + context.data_root;
    EXPECT_EQ(call("play --study x", environment).code, 2);
    EXPECT_EQ(call("play small --task wide", environment).code, 2);
}

TEST_F(StudyAtTheTrainer, AnExpertIsFlownOnceAndStandsBesideTheResult) {
    ::setenv("XDG_DATA_HOME", folder.path("home").c_str(), 1);
    start(true, "wide");
    push_to_the_end();
    ASSERT_TRUE(app->result().expert_wanted);
    const std::string home = folder.path("home/cathlab/experts");
    app->compare_with_expert();
    frames(2);
    ASSERT_TRUE(app->result().expert) << app->result().expert_note;
    EXPECT_GT(app->result().expert->course.tip.size(), 10U);
    EXPECT_GT(app->result().vessels.size(), 10U);
    const std::string run = fs::directory_iterator(home)->path().string();  // with the help's force limits laid over it
    const Outcome score = call("score " + run, "CATHLAB_DATA_DIR=" + context.data_root);
    EXPECT_EQ(score.code, 0) << score.text;
    start(true, "wide");  // the next time it is there already
    push_to_the_end();
    EXPECT_TRUE(app->result().expert);
    ::unsetenv("XDG_DATA_HOME");
}

}  // namespace
}  // namespace cathlab::play
