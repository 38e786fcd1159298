#include <gtest/gtest.h>

#include "calibrate/reference.h"
#include "scene/temporary_folder.h"

using namespace cathlab;

namespace {

std::string curve_fault(const TemporaryFolder& folder, const std::string& text) {
    const std::string path = folder.write("r.csv", text);
    return error_sentence([&] { read_stress_strain(path); });
}

std::string beat_fault(const TemporaryFolder& folder, const std::string& text) {
    const std::string path = folder.write("b.csv", text);
    return error_sentence([&] { read_beat_motion(path, 0.9); });
}

#define EXPECT_SAYS(sentence, part)                                        \
    do {                                                                   \
        const std::string said = sentence;                                 \
        EXPECT_NE(said.find(part), std::string::npos) << "said: " << said; \
    } while (false)

}  // namespace

TEST(ReferenceFile, TheProjectsOwnReferencesAreRead) {
    const std::string folder = std::string(CATHLAB_SOURCE_DIR) + "/assets/reference/";
    EXPECT_EQ(read_stress_strain(folder + "aorta-circumferential.csv").stress_kpa.size(), 30U);
    EXPECT_NEAR(at_phase(read_beat_motion(folder + "annulus-displacement.csv", 0.9), 0.45), 11.6, 1e-6);
}

TEST(ReferenceFile, ACurveIsReadInItsOwnUnitsAndPastOtherColumns) {
    const TemporaryFolder folder;
    const StressStrain kpa =
        read_stress_strain(folder.write("a.csv",
                                        "\xEF\xBB\xBF# source\r\n\r\nsample,stress_kpa,strain\r\nA, 0 ,0\r\n"
                                        "A,+20,0.1\r\n# more\r\nA,4e1,0.15\r\n"));
    EXPECT_EQ(kpa.stress_kpa, (std::vector{0.0, 20.0, 40.0}));
    EXPECT_EQ(kpa.strain, (std::vector{0.0, 0.1, 0.15}));
    EXPECT_EQ(kpa.line, (std::vector{4, 5, 7}));
    const StressStrain mpa =
        read_stress_strain(folder.write("b.csv", "strain_percent,stress_mpa\n0,0\n10,0.02\n15,0.04"));
    EXPECT_NEAR(mpa.stress_kpa[2], 40.0, 1e-12);
    EXPECT_NEAR(mpa.strain[2], 0.15, 1e-12);
}

TEST(ReferenceFile, EitherDirectionIsRightAndTurningRoundIsNot) {
    const TemporaryFolder folder;
    EXPECT_EQ(curve_fault(folder, "stress_kpa,strain\n60,0.3\n40,0.2\n20,0.1\n"), "no error");
    EXPECT_EQ(curve_fault(folder, "stress_kpa,strain\n-1,-0.3\n-2,-0.4\n-2,-0.41\n-3,-0.5\n"), "no error");
    EXPECT_EQ(curve_fault(folder, "run,stress_kpa,strain\n0,1,0.1\n0,2,0.2\n1,2,0.2\n1,1,0.1\n"), "no error");
    EXPECT_SAYS(curve_fault(folder, "stress_kpa,strain\n0,0\n20,0.1\n10,0.2\n"), "r.csv:4: stress: the stress turns");
    EXPECT_SAYS(curve_fault(folder, "stress_kpa,strain\n0,0\n20,0.1\n20,0.2\n10,0.2\n"), "r.csv:5");
    EXPECT_SAYS(curve_fault(folder, "run,stress_kpa,strain\n0,1,0.1\n1,5,0.2\n0,2,0.2\n0,1.5,0.1\n"), "r.csv:5");
}

TEST(ReferenceFile, HeadersThatDoNotFitAreToldWithTheNearestName) {
    const TemporaryFolder folder;
    const std::string rows = "0,0\n20,0.1\n40,0.2\n";
    EXPECT_SAYS(curve_fault(folder, "stress_psi,strain\n" + rows),
                "r.csv:1: stress_psi: is in an unknown unit; allowed: stress_kpa");
    EXPECT_SAYS(curve_fault(folder, "stress,strain\n" + rows),
                "stress: names no unit; allowed: stress_kpa, stress_mpa");
    EXPECT_SAYS(curve_fault(folder, "stres_kpa,strain\n" + rows), "did you mean 'stress_kpa'?");
    EXPECT_SAYS(curve_fault(folder, "stress_kpa,strian\n" + rows), "did you mean 'strain'?");
    EXPECT_SAYS(curve_fault(folder, "stress_kpa,strain_furlongs\n" + rows), "unknown unit");
    EXPECT_SAYS(curve_fault(folder, "stress_kpa,stress_kpa,strain\n0,0,0\n"), "a second column");
    EXPECT_SAYS(curve_fault(folder, "stress_kpa,stress_mpa,strain\n0,0,0\n"), "one of them");
    EXPECT_SAYS(curve_fault(folder, rows), "a line with the columns' names is wanted first");
    EXPECT_SAYS(curve_fault(folder, "a,b\n" + rows), "no column for the stress among a, b");
}

TEST(ReferenceFile, RowsThatAreNoNumbersAreToldByLineAndColumn) {
    const TemporaryFolder folder;
    const std::string begin = "# c\nstress_kpa,strain\n0,0\n";
    for (const char* cell : {"nan", "inf", "-inf", "1e999", "abc", "0x10", "1,5", "1 5", "--3", "+-3"})
        EXPECT_SAYS(curve_fault(folder, begin + "20," + cell + "\n40,0.2\n"), "r.csv:4");
    EXPECT_SAYS(curve_fault(folder, begin + "20,\n40,0.2\n"), "r.csv:4: strain: is empty");
    EXPECT_SAYS(curve_fault(folder, begin + "20\n40,0.2\n"), "found 1 cells; the header has 2");
    EXPECT_SAYS(curve_fault(folder, begin + "20,25\n40,0.2\n"), "strain_percent");
    EXPECT_SAYS(curve_fault(folder, begin + "2e9,0.1\n4e9,0.2\n"), "allowed: -1e+06 to 1e+06 kPa");
    EXPECT_SAYS(curve_fault(folder, "run,stress_kpa,strain\n0.5,1,0.1\n"), "a whole number");
}

TEST(ReferenceFile, HostileFilesGetASentence) {
    const TemporaryFolder folder;
    EXPECT_SAYS(curve_fault(folder, ""), "is empty");
    EXPECT_SAYS(curve_fault(folder, "# only\n# comments\n"), "is empty");
    EXPECT_SAYS(curve_fault(folder, "stress_kpa,strain\n"), "has 0 rows");
    EXPECT_SAYS(curve_fault(folder, "stress_kpa,strain\n0,0\n20,0.1\n"), "has 2 rows");
    EXPECT_SAYS(curve_fault(folder, std::string("\0\1\2", 3)), "not a text file");
    EXPECT_SAYS(curve_fault(folder, std::string(1000, '\x1b')), "among ???");
    EXPECT_SAYS(curve_fault(folder, std::string(3000000, ',')), "more than 200 columns");
    EXPECT_SAYS(curve_fault(folder, std::string((16U << 20U) + 1, 'x')), "larger than");
    EXPECT_SAYS(error_sentence([&] { read_stress_strain(folder.path()); }), "folder");
    EXPECT_SAYS(error_sentence([&] { read_stress_strain(folder.path("none.csv")); }), "none.csv");
    EXPECT_LT(curve_fault(folder, std::string(100000, 'x') + "\n").size(), 400U);
}

TEST(ReferenceFile, ABeatIsReadByPhaseOrByTime) {
    const TemporaryFolder folder;
    const BeatMotion phase =
        read_beat_motion(folder.write("p.csv", "phase,displacement_cm\n0,0\n0.25,0.5\n0.5,1\n0.75,0.5\n1,0\n"), 0.9);
    EXPECT_NEAR(phase.displacement_mm[2], 10.0, 1e-12);
    const BeatMotion time =
        read_beat_motion(folder.write("t.csv", "t_ms,displacement_mm\n0,0\n225,5\n450,10\n675,5\n800,2\n"), 0.9);
    EXPECT_NEAR(time.phase[2], 0.5, 1e-12);
    EXPECT_NEAR(at_phase(phase, 0.375), 7.5, 1e-12);
    EXPECT_NEAR(at_phase(phase, 2.375), 7.5, 1e-12);
    EXPECT_NEAR(at_phase(phase, -0.125), 2.5, 1e-12);
    EXPECT_NEAR(at_phase(time, 0.0), 0.0, 1e-12);
    const double half_way = 0.5 * (800.0 / 900.0 + 1.0);  // over the end of the beat to the first row
    EXPECT_NEAR(at_phase(time, half_way), 1.0, 1e-9);
}

TEST(ReferenceFile, ABadBeatIsToldByItsRow) {
    const TemporaryFolder folder;
    const std::string rows = "0,0\n0.2,5\n0.4,8\n0.6,4\n";
    EXPECT_SAYS(beat_fault(folder, "phase,displacement_mm\n" + rows), "at least 5");
    EXPECT_SAYS(beat_fault(folder, "phase,displacement_mm\n" + rows + "0.5,1\n"), "b.csv:6: phase");
    EXPECT_SAYS(beat_fault(folder, "phase,displacement_mm\n" + rows + "1.2,1\n"), "b.csv:6: phase");
    EXPECT_SAYS(beat_fault(folder, "phase,displacement_mm\n" + rows + "1,1\n"), "the same moment");
    EXPECT_SAYS(beat_fault(folder, "phase,displacement_mm\n" + rows + "0.9,80\n"), "allowed: -40 to 40 mm");
    EXPECT_SAYS(beat_fault(folder, "phase,displacement_um\n" + rows + "0.9,1\n"), "unknown unit");
    EXPECT_SAYS(beat_fault(folder, "fase,displacement_mm\n" + rows + "0.9,1\n"), "did you mean 'phase'?");
    EXPECT_SAYS(beat_fault(folder, "phase,t_s,displacement_mm\n0,0,0\n"), "one of them");
    EXPECT_SAYS(beat_fault(folder, "t_s,displacement_mm\n" + rows + "1.1,1\n"), "one beat is wanted");
}
