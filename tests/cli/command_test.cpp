// Command lines: what is taken and refused, and what help, man pages and shell completion say about them.
// cli_command_test.py tests what shells do with the scripts.
#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "tests/cli/sample_command.h"

namespace twinray::cli {
namespace {

SampleValues parsed(const std::vector<std::string>& arguments) {
    SampleValues values;
    EXPECT_TRUE(parse(sample_command(values), arguments));
    return values;
}

std::string refusal_of(const std::vector<std::string>& arguments) {
    SampleValues values;
    try {
        parse(sample_command(values), arguments);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "nothing is wrong";
}

TEST(Parse, ValuesGoWhereTheyAreBound) {
    const SampleValues values = parsed({"a.ply", "--accel", "sw", "--levels=watertight,fast", "--count", "7", "--up",
                                        "-1", "-.5", "1e-3", "--within", "+2.5", "--quiet"});
    EXPECT_EQ(values.scene, "a.ply");
    EXPECT_EQ(values.accel, "sw");
    EXPECT_EQ(values.levels, (std::vector<std::string>{"watertight", "fast"}));
    EXPECT_EQ(values.count, 7u);
    EXPECT_EQ(values.up, (std::vector<float>{-1, -0.5f, 1e-3f}));
    EXPECT_EQ(values.within, 2.5);
    EXPECT_TRUE(values.quiet);
}

// This also holds on Windows, where the parser of others takes them for options.
TEST(Parse, NamesOfFilesMayBeginWithASlash) {
    const SampleValues values = parsed({"/a.ply", "-o", "/here"});
    EXPECT_EQ(values.scene, "/a.ply");
    EXPECT_EQ(values.output, "/here");
}

TEST(Parse, WhatIsNotGivenKeepsItsDefault) {
    const SampleValues values = parsed({"a.ply"});
    EXPECT_EQ(values.accel, "auto");
    EXPECT_EQ(values.count, 5u);
    EXPECT_EQ(values.within, std::nullopt);
    EXPECT_FALSE(values.quiet || values.is_growth);
}

TEST(Parse, ListsLettersRepetitionsAndFormerNames) {
    EXPECT_EQ(parsed({"-o", "here", "a.ply"}).output, "here");
    EXPECT_EQ(parsed({"a.ply", "--picture", "1.png", "--picture", "2.GLB"}).pictures,
              (std::vector<std::filesystem::path>{"1.png", "2.GLB"}));
    testing::internal::CaptureStderr();
    EXPECT_EQ(parsed({"a.ply", "--rays", "3"}).count, 3u) << "--count was called so";
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "twinray: --rays is now called --count\n");
    const SampleValues alone = parsed({"a.ply", "--growth"});
    EXPECT_TRUE(alone.is_growth && alone.growth.size() == 2);
    EXPECT_EQ(parsed({"a.ply", "--growth", "1e3,5"}).growth, (std::vector<double>{1000, 5}));
}

TEST(Parse, HelpComesBeforeAllFaults) {
    SampleValues values;
    EXPECT_FALSE(parse(sample_command(values), {"--frob", "--help"}));
    EXPECT_FALSE(parse(sample_command(values), {"-h"}));
    EXPECT_FALSE(parse(sample_command(values), {"-hx"})) << "a letter among others";
}

TEST(Parse, RefusalsNameOptionValueAndWhatIsAllowed) {
    EXPECT_EQ(refusal_of({"a.ply", "--count", "12"}), "--count is '12', but must be a whole number from 1 to 9");
    EXPECT_EQ(refusal_of({"a.ply", "--count", "2.5"}), "--count is '2.5', but must be a whole number from 1 to 9");
    EXPECT_EQ(refusal_of({"a.ply", "--count", "-1"}), "--count is '-1', but must be a whole number from 1 to 9");
    EXPECT_EQ(refusal_of({"a.ply", "--within", "nan"}), "--within is 'nan', but must be a finite number at least 0");
    EXPECT_EQ(refusal_of({"a.ply", "--within", "1e999"}),
              "--within is '1e999', but must be a finite number at least 0");
    EXPECT_EQ(refusal_of({"a.ply", "--accel", "gpu"}), "--accel is 'gpu', but must be auto, sw or hw");
    EXPECT_EQ(refusal_of({"a.ply", "--accel", "aut"}),
              "--accel is 'aut', but must be auto, sw or hw; did you mean auto?");
    EXPECT_EQ(refusal_of({"a.ply", "--levels", "fast,wet"}), "--levels is 'wet', but must be fast or watertight");
    EXPECT_EQ(refusal_of({"a.ply", "--picture", "a.jpg"}),
              "--picture is 'a.jpg', but must be a file whose name ends in .png or .glb");
}

TEST(Parse, RefusalsNameWhatIsMissingOrTooMuch) {
    EXPECT_EQ(refusal_of({}), "SCENE is required");
    EXPECT_EQ(refusal_of({"a.ply", "b.ply"}), "'b.ply' is one argument too many");
    EXPECT_EQ(refusal_of({"a.ply", "--acel", "sw"}), "there is no option --acel; did you mean --accel?");
    EXPECT_EQ(refusal_of({"a.ply", "--zzz"}), "there is no option --zzz");
    EXPECT_EQ(refusal_of({"a.ply", "--count"}), "--count needs N, but nothing follows");
    EXPECT_EQ(refusal_of({"a.ply", "--count", "--quiet"}), "--count needs N, but --quiet follows");
    EXPECT_EQ(refusal_of({"a.ply", "--count", "3", "--count", "4"}), "--count is given more than once");
    EXPECT_NE(refusal_of({"a.ply", "--count", "3", "--up", "1", "2"}).find("--up"), std::string::npos);
}

TEST(Parse, WhatDoesNotGoTogetherIsRefused) {
    EXPECT_EQ(refusal_of({"a.ply", "--up", "0", "1", "0"}), "--up requires --count");
    EXPECT_EQ(refusal_of({"a.ply", "--picture", "a.png", "-o", "b"}), "--picture excludes --output");
    EXPECT_EQ(refusal_of({"a.ply", "--within", "1", "--growth"}), "only one of --within, --growth may be given");
}

TEST(Suggest, DistanceCountsLettersThatDiffer) {
    EXPECT_EQ(edit_distance("", ""), 0u);
    EXPECT_EQ(edit_distance("trace", "trace"), 0u);
    EXPECT_EQ(edit_distance("", "abc"), 3u);
    EXPECT_EQ(edit_distance("trce", "trace"), 1u);
    EXPECT_EQ(edit_distance("traces", "trace"), 1u);
    EXPECT_EQ(edit_distance("trake", "trace"), 1u);
    EXPECT_EQ(edit_distance("tarce", "trace"), 1u) << "neighbours swapped";
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
}

TEST(Suggest, TheNearestIsOnlyNamedWhereItIsNear) {
    const std::vector<std::string> commands = {"trace", "verify", "leaks", "bench"};
    EXPECT_EQ(nearest_to("trase", commands), "trace");
    EXPECT_EQ(nearest_to("verfy", commands), "verify");
    EXPECT_EQ(nearest_to("leak", commands), "leaks");
    EXPECT_EQ(nearest_to("ver", commands), "verify") << "begun";
    EXPECT_EQ(nearest_to("v", commands), "");
    EXPECT_EQ(nearest_to("frob", commands), "");
    EXPECT_EQ(nearest_to("x", {}), "");
}

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

TEST(Completion, EachScriptNamesCommandsOptionsAndChoices) {
    SampleValues values;
    const std::vector<Command> commands = {sample_command(values)};
    for (const std::string& script : {bash_completion(commands), zsh_completion(commands), fish_completion(commands)}) {
        EXPECT_TRUE(has(script, "probe")) << script;
        EXPECT_TRUE(has(script, "auto sw hw")) << script;
        EXPECT_TRUE(has(script, "within")) << script;
        EXPECT_FALSE(has(script, "--rays")) << "former names are not shown\n" << script;
    }
}

TEST(Completion, HelpsAreCutWhereDetailsBegin) {
    SampleValues values;
    const std::vector<Command> commands = {sample_command(values)};
    EXPECT_TRUE(has(fish_completion(commands), "-l quiet -d 'say nothing'\n"));
    EXPECT_TRUE(has(zsh_completion(commands), "'--quiet[say nothing]'"));
}

}  // namespace
}  // namespace twinray::cli
