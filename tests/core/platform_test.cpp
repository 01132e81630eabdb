// SPDX-License-Identifier: MIT
// Features that each system implements in its own way: starting programs, folders, memory.
#include "engine/core/platform.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/scene/temp_dir.h"

namespace twinray {
namespace {

const std::vector<std::string> hard_words = {"a b", "", "\"", "a\\", "a\\\\\"b c\\\\", "*", "100%", "$HOME", "\t"};

// Runs in the process that the tests below start, and does what its environment says.
TEST(PlatformChild, DoesWhatItIsTold) {
    const char* const told = std::getenv("TWINRAY_TEST_CHILD");
    const std::string what = told ? told : "";
    const std::vector<std::string> words = ::testing::internal::GetArgvs();
    if (what == "words") std::_Exit(std::ranges::search(words, hard_words).empty() ? 1 : 42);
    if (what == "abort") std::abort();
}

std::optional<platform::ProgramEnd> child(const std::string& what) {
    std::vector<std::string> words = {"--gtest_filter=PlatformChild.*"};
    words.insert(words.end(), hard_words.begin(), hard_words.end());
    return platform::run_program({{}, words, {{"TWINRAY_TEST_CHILD", what}, {"GTEST_OUTPUT", ""}}, /*is_silent*/ true});
}

TEST(Platform, AProgramGetsItsWordsAndVariablesAndItsStatusComesBack) {
    const auto end = child("words");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->fault, "");
    EXPECT_EQ(end->status, 42);
}

TEST(Platform, AProgramThatTheSystemEndsIsToldFromOneThatEnds) {
    const auto whole = child("nothing"), aborted = child("abort");
    ASSERT_TRUE(whole && aborted);
    EXPECT_EQ(whole->fault, "");
    EXPECT_EQ(whole->status, 0);
    constexpr int status_of_abort_on_windows = 3;
    EXPECT_TRUE(!aborted->fault.empty() || aborted->status == status_of_abort_on_windows) << aborted->status;
}

TEST(Platform, AProgramThatIsNotThereIsNotStarted) {
    EXPECT_FALSE(platform::run_program({"no such program of twinray"}));
    platform::become_program({"no such program of twinray"});  // returns
}

TEST(Platform, ThisProgramIsAFile) { EXPECT_TRUE(std::filesystem::is_regular_file(platform::this_program())); }

TEST(Platform, TemporaryFoldersAreNewAndTakeFilesOfAnyName) {
    const test::TempDir a, b;
    EXPECT_NE(a / "", b / "");
    const std::string name =
        "K\xc3\xa4"
        "fig \xe2\x82\xac";
    EXPECT_EQ(a.write(name, "x").filename().string(), name);
    EXPECT_TRUE(std::filesystem::exists(a / name));
}

TEST(Platform, MappedMemoryIsToldFromOther) {
    const int here = 0;
    EXPECT_TRUE(platform::is_mapped(reinterpret_cast<std::uint64_t>(&here)));
    EXPECT_FALSE(platform::is_mapped(std::uint64_t{1} << 50)) << "beyond all addresses of programs";
}

TEST(Platform, SecondsOfProcessorsGrow) {
    const auto before = platform::processor_seconds();
    if (!before) GTEST_SKIP() << "the system does not tell";
    const auto after = platform::processor_seconds();
    EXPECT_GE(after->all, before->all);
    EXPECT_GE(after->own, before->own);
    EXPECT_LE(after->busy, after->all);
}

TEST(Platform, NobodyListensAtPort1) { EXPECT_FALSE(platform::Connection::open("127.0.0.1", "1", 1)); }

}  // namespace
}  // namespace twinray
