// SPDX-License-Identifier: MIT
#include "cli/command/parse.h"

#include <gtest/gtest.h>

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
    EXPECT_EQ(refusal_of({"a.ply", "b.ply"}), "'b.ply' is one word too many");
    EXPECT_EQ(refusal_of({"a.ply", "--acel", "sw"}), "there is no option --acel; did you mean --accel?");
    EXPECT_EQ(refusal_of({"a.ply", "--zzz"}), "there is no option --zzz");
    EXPECT_EQ(refusal_of({"a.ply", "--count"}), "--count wants N, and nothing follows");
    EXPECT_EQ(refusal_of({"a.ply", "--count", "--quiet"}), "--count wants N, but --quiet follows");
    EXPECT_EQ(refusal_of({"a.ply", "--count", "3", "--count", "4"}), "--count is given more than once");
    EXPECT_NE(refusal_of({"a.ply", "--count", "3", "--up", "1", "2"}).find("--up"), std::string::npos);
}

TEST(Parse, WhatDoesNotGoTogetherIsRefused) {
    EXPECT_EQ(refusal_of({"a.ply", "--up", "0", "1", "0"}), "--up requires --count");
    EXPECT_EQ(refusal_of({"a.ply", "--picture", "a.png", "-o", "b"}), "--picture excludes --output");
    EXPECT_EQ(refusal_of({"a.ply", "--within", "1", "--growth"}), "only one of --within, --growth may be given");
}

}  // namespace
}  // namespace twinray::cli
