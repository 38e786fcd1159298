#include "scene/script.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "scene/temporary_folder.h"

namespace cathlab {
namespace {

std::string error_of(const std::string& text) {
    return error_sentence([&] { Script::parse(text, "s.csv"); });
}
const std::string header = "t_s,action,value\n";

TEST(Script, AHeldActionKeepsItsValueUntilTheNextRow) {
    const Script s = Script::parse(header + "1,advance,30\n3,advance,-5\n", "s.csv");
    EXPECT_EQ(s.at(0.99).advance, 0.0);
    EXPECT_EQ(s.at(1.0).advance, 30.0);
    EXPECT_EQ(s.at(2.999).advance, 30.0);
    EXPECT_EQ(s.at(3.0).advance, -5.0);
    EXPECT_EQ(s.at(100.0).advance, -5.0);
    EXPECT_EQ(s.end_s(), 3.0);
    EXPECT_EQ(s.row_count(), 2U);
}

TEST(Script, ALinearActionGoesStraightFromRowToRow) {
    const Script s = Script::parse(header + "1,distal_bend,0\n3,distal_bend,100\n", "s.csv");
    EXPECT_DOUBLE_EQ(s.at(2.0).distal_bend, 50.0);
    EXPECT_DOUBLE_EQ(s.at(2.5).distal_bend, 75.0);
    EXPECT_DOUBLE_EQ(s.at(9.0).distal_bend, 100.0);
}

TEST(Script, AViewIsBothAnglesAtOnce) {
    const Script s = Script::parse(header + "1,primary_angle,10\n3,view,spider\n5,view,ap\n", "s.csv");
    EXPECT_DOUBLE_EQ(s.at(2.9).primary_angle, 10.0);  // no creeping towards it
    EXPECT_DOUBLE_EQ(s.at(3.0).primary_angle, 45.0);
    EXPECT_DOUBLE_EQ(s.at(4.0).secondary_angle, -30.0);
    EXPECT_DOUBLE_EQ(s.at(6.0).primary_angle, 0.0);
    EXPECT_NE(error_of(header + "1,view,spyder\n").find("spider"), std::string::npos);
}

TEST(Script, WhatThePedalExposesHasNames) {
    const Script s =
        Script::parse(header + "1,acquisition,dsa\n2,acquisition,cine\n2,fluoroscopy_level,low\n", "s.csv");
    EXPECT_EQ(s.at(1.0).acquisition, 2.0);
    EXPECT_EQ(s.at(2.0).acquisition, 1.0);
    EXPECT_EQ(s.at(0.0).fluoroscopy_level, 1.0);
    EXPECT_EQ(s.at(2.0).fluoroscopy_level, 0.0);
    EXPECT_NE(error_of(header + "1,acquisition,1.5\n").find("fluoroscopy, cine or dsa"), std::string::npos);
}

TEST(Script, TwoRowsAtOneTimeAreAJump) {
    const Script s =
        Script::parse(header + "0,distal_bend,0\n1,distal_bend,10\n1,distal_bend,90\n2,distal_bend,90\n", "s.csv");
    EXPECT_NEAR(s.at(0.999999).distal_bend, 10.0, 1e-4);
    EXPECT_EQ(s.at(1.0).distal_bend, 90.0);
}

TEST(Script, TheBaseSpeaksWhereTheScriptIsSilent) {
    const Script s = Script::parse(header + "2,primary_angle,40\n", "s.csv");
    Input base;
    base.primary_angle = 10;
    base.secondary_angle = -20;
    EXPECT_EQ(s.at(1.0, base).primary_angle, 10.0);
    EXPECT_EQ(s.at(2.0, base).primary_angle, 40.0);
    EXPECT_EQ(s.at(2.0, base).secondary_angle, -20.0);
}

TEST(Script, DevicesHaveNames) {
    const Script s = Script::parse(
        "# a comment\r\n\r\nt_s, action, value\r\n0,device,catheter\r\n1,device,wire\r\n2,device,1", "s.csv");
    EXPECT_EQ(s.at(0.5).device, 1.0);
    EXPECT_EQ(s.at(1.5).device, 0.0);
    EXPECT_EQ(s.at(2.5).device, 1.0);
}

TEST(Script, EveryFaultNamesItsLine) {
    EXPECT_EQ(error_of(""), "s.csv: is empty; the header t_s,action,value is wanted first");
    EXPECT_NE(error_of("0,advance,3\n").find("s.csv:1: found '0,advance,3'; the header"), std::string::npos);
    EXPECT_NE(error_of(header + "0,advnce,3").find("s.csv:2: action: no action 'advnce'; did you mean 'advance'?"),
              std::string::npos);
    EXPECT_NE(error_of(header + "0,advance,101").find("s.csv:2: advance: found 101; a number from -100 to 100 mm/s"),
              std::string::npos);
    EXPECT_NE(error_of(header + "0,advance,fast").find("found 'fast'; a number"), std::string::npos);
    EXPECT_NE(error_of(header + "0,advance,3mm").find("found '3mm'; a number"), std::string::npos);
    EXPECT_NE(error_of(header + "0,advance,\x1b[2J").find("found '?[2J'; a number"), std::string::npos);
    EXPECT_NE(error_of(header + "0,advance,nan").find("found 'nan'"), std::string::npos);
    EXPECT_NE(error_of(header + "0,advance,inf").find("found 'inf'"), std::string::npos);
    EXPECT_NE(error_of(header + "0,advance,1e999").find("found '1e999'"), std::string::npos);
    EXPECT_NE(error_of(header + "nan,advance,1").find("s.csv:2: t_s: found 'nan'"), std::string::npos);
    EXPECT_NE(error_of(header + "-1,advance,1").find("a time from 0"), std::string::npos);
    EXPECT_NE(error_of(header + "2,advance,1\n1,advance,1").find("s.csv:3: t_s: time runs back: 1 s after 2 s"),
              std::string::npos);
    EXPECT_NE(error_of(header + "0,advance").find("found 2 cells"), std::string::npos);
    EXPECT_NE(error_of(header + "0,advance,1,2").find("found 4 cells"), std::string::npos);
    EXPECT_NE(error_of(header + "0,device,sheath").find("wire or catheter is wanted"), std::string::npos);
    EXPECT_NE(error_of(header + "0,device,0.5").find("wire or catheter is wanted"), std::string::npos);
}

TEST(Script, MissingBinaryAndHugeFilesAreRefused) {
    const TemporaryFolder folder;
    EXPECT_THROW(Script::load(folder.path("missing.csv")), UserError);
    EXPECT_THROW(Script::load(folder.path()), UserError);
    EXPECT_THROW(Script::load(folder.write("binary.csv", std::string("t_s\0\1", 5))), UserError);
}

}  // namespace
}  // namespace cathlab
