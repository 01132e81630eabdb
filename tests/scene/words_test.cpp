// SPDX-License-Identifier: MIT
#include "engine/scene/importers/words.h"

#include <cmath>

#include "tests/scene/temp_dir.h"

namespace twinray::test {
namespace {

TEST(Words, LinesEndInThreeWays) {
    std::string_view rest = "a\n\nb\r\n\r\nc\r\rd\n";
    for (const char* line : {"a", "", "b", "", "c", "", "d"}) EXPECT_EQ(cut_line(rest), line);
    EXPECT_TRUE(rest.empty());
    EXPECT_EQ(cut_line(rest), "");
}

TEST(Words, WordsStandBetweenBlanks) {
    std::string_view rest = " \tone  two\v ";
    EXPECT_EQ(cut_word(rest), "one");
    EXPECT_EQ(cut_word(rest), "two");
    EXPECT_EQ(cut_word(rest), "");
    EXPECT_EQ(trimmed(" \t a b\r\n"), "a b");
    EXPECT_EQ(trimmed(" \n"), "");
    EXPECT_EQ(lowered("Solid \xc3\x84"), "solid \xc3\x84");
}

TEST(Words, NumbersAreWholeWords) {
    for (const auto& [word, value] : std::initializer_list<std::pair<const char*, double>>{{"1", 1},
                                                                                           {"+2.5E+000", 2.5},
                                                                                           {"-.5", -0.5},
                                                                                           {"3.", 3},
                                                                                           {"0.1", 0.1},
                                                                                           {"1e999", INFINITY},
                                                                                           {"-1e999", -INFINITY},
                                                                                           {"1e-999", 0},
                                                                                           {"inf", INFINITY},
                                                                                           {"1.#INF", INFINITY},
                                                                                           {"-1.#INF00", -INFINITY}})
        EXPECT_EQ(parse_number(word), value) << word;
    for (const char* word : {"nan", "-nan", "NaN", "nan(ind)", "-1.#IND", "1.#QNAN", "1.#IND00"})
        EXPECT_TRUE(parse_number(word) && std::isnan(*parse_number(word))) << word;
    for (const char* word : {"", "+", "-", "x", "1x", "1,5", "0x1", "1.5#INF", "2.#INF", "1#INF", "#"})
        EXPECT_FALSE(parse_number(word)) << word;
}

TEST(Words, TextHasNoMarkAndNoZeroByte) {
    const Bytes marked = {0xef, 0xbb, 0xbf, 'a'}, utf16 = {0xff, 0xfe, 'a', 0};
    EXPECT_EQ(text_of(marked, "x"), "a");
    EXPECT_EQ(text_of({}, "x"), "");
    expect_contains(error_of([&] { text_of(utf16, "file"); }),
                    "'file': not a text file in ASCII or UTF-8 (byte 3 is zero)");
}

}  // namespace
}  // namespace twinray::test
