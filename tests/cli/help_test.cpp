// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <sstream>

#include "cli/command/help_text.h"
#include "cli/command/man_page.h"
#include "tests/cli/sample_command.h"

namespace twinray::cli {
namespace {

std::string sample_help(std::size_t width) {
    SampleValues values;
    return help_text(sample_command(values), width);
}

TEST(HelpText, HasTheSectionsOfAManPage) {
    const std::string help = sample_help(80);
    std::size_t at = 0;
    for (const char* heading :
         {"NAME\n", "SYNOPSIS\n", "DESCRIPTION\n", "OPTIONS\n", "EXAMPLES\n", "EXIT STATUS\n", "ENVIRONMENT\n"}) {
        const std::size_t found = help.find(heading, at);
        ASSERT_NE(found, std::string::npos) << heading;
        at = found;
    }
    EXPECT_TRUE(has(help, "twinray probe SCENE [OPTION]...")) << help;
}

TEST(HelpText, OptionsTellChoicesRangesAndDefaults) {
    const std::string help = sample_help(80);
    EXPECT_TRUE(has(help, "--accel auto|sw|hw\n            what traces (default: auto)\n")) << help;
    EXPECT_TRUE(has(help, "--levels fast|watertight,...\n            levels; any of them (default: fast)\n")) << help;
    EXPECT_TRUE(has(help, "--count N\n            how many (from 1 to 9, default: 5)\n")) << help;
    EXPECT_TRUE(has(help, "--up X Y Z\n            where up is (default: 0 1 0)\n")) << help;
    EXPECT_TRUE(has(help, "--growth [N,...]\n")) << help;
    EXPECT_TRUE(has(help, "-o, --output FOLDER\n")) << help;
    EXPECT_TRUE(has(help, "something is wrong; or ")) << "what exit status 1 means";
    EXPECT_FALSE(has(help, "--rays")) << "former names are not shown";
    EXPECT_FALSE(has(help, "ENUM"));
}

TEST(HelpText, LinesKeepToTheWidth) {
    for (const std::size_t width : {50u, 80u, 100u}) {
        std::istringstream lines(sample_help(width));
        for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), width) << line;
    }
    EXPECT_EQ(wrapped("a bb ccc", 6, 2), "  a bb\n  ccc\n");
    EXPECT_EQ(wrapped("unbreakable a", 4, 1), " unbreakable\n a\n");
    EXPECT_EQ(wrapped("", 4, 1), "");
}

TEST(HelpText, TheListHasALineForEachCommand) {
    SampleValues values;
    const std::vector<Command> commands = {sample_command(values), {.name = "b", .group = "Other", .summary = "do b"}};
    const std::string list = list_text(commands, 80);
    EXPECT_TRUE(has(list, "\nTracing\n    probe  try values\n\nOther\n    b      do b\n")) << list;
}

TEST(ManPage, WhatRoffWouldReadIsEscaped) {
    SampleValues values;
    Command command = sample_command(values);
    command.description = ".TP of 'a\\b' is no macro";
    const std::string page = man_page(command, "1.0");
    EXPECT_TRUE(page.starts_with(".TH \"TWINRAY-PROBE\" 1")) << page;
    EXPECT_TRUE(has(page, "\n\\&.TP of \\(aqa\\eb\\(aq is no macro\n")) << page;
    EXPECT_TRUE(has(page, "twinray\\-probe \\- try values\n")) << page;
    EXPECT_TRUE(has(page, ".B \\-o, \\-\\-output FOLDER\n")) << page;
}

}  // namespace
}  // namespace twinray::cli
