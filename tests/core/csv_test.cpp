#include "core/csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>

using namespace cathlab;

namespace {

using Cells = std::vector<std::string_view>;

std::vector<std::pair<int, Cells>> lines_of(std::string_view text) {
    std::vector<std::pair<int, Cells>> out;
    for (CsvLines lines(text); lines.next();) out.emplace_back(lines.number(), lines.cells());
    return out;
}

}  // namespace

TEST(Csv, ALineIsCutAtItsCommasAndNowhereElse) {
    EXPECT_EQ(cells_of("t_s, action ,\tvalue\r"), (Cells{"t_s", "action", "value"}));
    EXPECT_EQ(cells_of(""), (Cells{""}));
    EXPECT_EQ(cells_of(","), (Cells{"", ""}));
    EXPECT_EQ(cells_of("a b;c"), (Cells{"a b;c"}));
    EXPECT_EQ(cells_of("\"1,5\",2"), (Cells{"\"1", "5\"", "2"}));  // a quote is a character
    const std::string zero("a\0b,c\0", 6);
    EXPECT_EQ(cells_of(zero), (Cells{std::string_view(zero).substr(0, 3), std::string_view(zero).substr(4, 2)}));
}

TEST(Csv, AFileOfCommasDoesNotFillTheMemory) {
    const std::string commas(1U << 20U, ',');
    const Cells cells = cells_of(commas);
    EXPECT_EQ(cells.size(), 10000U);
    EXPECT_EQ(cells.back().size(), commas.size() - 9999U);
    const std::string one(1U << 20U, 'x');
    EXPECT_EQ(cells_of(one), (Cells{one}));
}

TEST(Csv, LinesKeepTheirNumbersPastMarksCommentsAndEmptyLines) {
    EXPECT_EQ(lines_of("\xEF\xBB\xBF# source\r\n\r\n \t\na,b\r\n1,2\n  # more\n3,4"),
              (std::vector<std::pair<int, Cells>>{{4, {"a", "b"}}, {5, {"1", "2"}}, {7, {"3", "4"}}}));
    EXPECT_EQ(lines_of("a\n\xEF\xBB\xBF"), (std::vector<std::pair<int, Cells>>{{1, {"a"}}, {2, {"\xEF\xBB\xBF"}}}));
    EXPECT_TRUE(lines_of("").empty());
    EXPECT_TRUE(lines_of("\n\r\n#").empty());
    EXPECT_EQ(lines_of("1\r2\n").size(), 1U);  // a bare carriage return ends no line
    EXPECT_EQ(lines_of(",").size(), 1U);
    CsvLines lines("a");
    EXPECT_TRUE(lines.next());
    EXPECT_FALSE(lines.next());
    EXPECT_FALSE(lines.next());
    EXPECT_TRUE(lines.text().empty());
}

TEST(Csv, AFiniteNumberIsTheWholeCell) {
    EXPECT_EQ(finite_number("1.5"), 1.5);
    EXPECT_EQ(finite_number("+1.5e3"), 1500.0);
    EXPECT_EQ(finite_number("-.5"), -0.5);
    EXPECT_EQ(finite_number("1e-300"), 1e-300);
    EXPECT_TRUE(std::signbit(finite_number("-0").value()));
    for (const char* bad : {"",
                            "+",
                            "-",
                            ".",
                            "e5",
                            "+-5",
                            "++5",
                            "--5",
                            "+ 5",
                            " 5",
                            "5 ",
                            "1,5",
                            "1e",
                            "1_000",
                            "1.2.3",
                            "5mm",
                            "\"5\"",
                            "nan",
                            "-nan",
                            "NAN",
                            "nan(1)",
                            "inf",
                            "+inf",
                            "-INFINITY",
                            "1e999",
                            "-1e999",
                            "0x10",
                            "0x1p3",
                            "0b1",
                            "1f",
                            "\xD9\xA1",
                            "\xEF\xBB\xBF"
                            "5"})
        EXPECT_FALSE(finite_number(bad).has_value()) << bad;
    EXPECT_FALSE(finite_number(std::string_view("5\0", 2)).has_value());
    EXPECT_FALSE(finite_number(std::string_view("5\0006", 3)).has_value());
    EXPECT_FALSE(finite_number(std::string(1U << 20U, '9')).has_value());
    EXPECT_EQ(finite_number("1" + std::string(100000, '0') + "e-100000"), 1.0);
}

TEST(Csv, ANumberOfATypeIsReadWholeOrNotAtAll) {
    EXPECT_EQ(parse_number<std::int64_t>("-12"), -12);
    EXPECT_TRUE(std::isnan(parse_number<double>("nan").value()));
    for (const char* bad : {"", "+1", "1.0", "1 ", "0x1", "9223372036854775808"})
        EXPECT_FALSE(parse_number<std::int64_t>(bad).has_value()) << bad;
}

TEST(Csv, WhatIsShownIsShortAndNothingThatATerminalObeys) {
    EXPECT_EQ(shown("advnce"), "advnce");
    EXPECT_EQ(shown("\x1b[2Ja\r\n\tb\x7f"), "?[2Ja???b?");
    EXPECT_EQ(shown(std::string_view("a\0b", 3)), "a?b");
    EXPECT_EQ(shown("d\xC3\xA9j\xC3\xA0 \xE2\x82\xAC \xF0\x9F\x98\x80"),
              "d\xC3\xA9j\xC3\xA0 \xE2\x82\xAC \xF0\x9F\x98\x80");
    EXPECT_EQ(shown("\xC2\x9B"
                    "2J"),
              "??2J");  // CSI as one character
    EXPECT_EQ(shown("\x9B"
                    "2J\xFF\xC3"),
              "?2J??");                            // no UTF-8
    EXPECT_EQ(shown("\xC0\x9B\xC1\xBF"), "????");  // controls in two bytes that none needs
    EXPECT_EQ(shown("\xE0\x82\x9B"), "???");
    EXPECT_EQ(shown(std::string(1U << 20U, 'x')).size(), 60U);
    EXPECT_EQ(shown("abcdef", 3), "abc");
    EXPECT_EQ(shown("ab\xE2\x82\xAC", 4), "ab");  // no half of a character
    EXPECT_EQ(shown("abc", 0), "");
}
