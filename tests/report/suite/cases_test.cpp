// The suite's cases: all of them, the order of their turns, and the state that a run leaves for the next.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "engine/core/error.h"
#include "report/suite/suite.h"
#include "tests/scene/temp_dir.h"

namespace twinray::suite {
namespace {

TEST(Catalogue, HasEveryCaseOnce) {
    std::set<std::string> ids;
    for (const SuiteCase& row : catalogue()) EXPECT_TRUE(ids.insert(row.id).second) << row.id << " is there twice";
    const std::map<char, int> sizes = {{'W', 17}, {'S', 13}, {'T', 17}, {'N', 15}, {'I', 16}, {'B', 16}, {'F', 9},
                                       {'L', 4},  {'V', 15}, {'R', 2},  {'G', 6},  {'C', 14}, {'D', 8},  {'P', 19}};
    std::size_t total = 0;
    for (const auto& [letter, size] : sizes)
        for (int i = 1; i <= size; ++i, ++total) {
            const std::string id = letter + std::string(i < 10 ? "0" : "") + std::to_string(i);
            EXPECT_TRUE(ids.contains(id)) << id << " is missing";
        }
    EXPECT_EQ(ids.size(), total);
}

TEST(Catalogue, EachRowSaysWhatItIsAndRuns) {
    for (const SuiteCase& row : catalogue()) {
        EXPECT_FALSE(row.title.empty() || row.measures.empty() || row.criterion.empty()) << row.id;
        EXPECT_FALSE(section_of(row.id).empty()) << row.id;
        EXPECT_TRUE(row.run) << row.id;
    }
}

TEST(Catalogue, IdsAreChosenByPattern) {
    EXPECT_TRUE(matches("W04", "W04"));
    EXPECT_TRUE(matches("W04", "W*"));
    EXPECT_TRUE(matches("W04", "*"));
    EXPECT_TRUE(matches("W04", "?04"));
    EXPECT_TRUE(matches("W04", "W*4"));
    EXPECT_FALSE(matches("W04", "W0"));
    EXPECT_FALSE(matches("W04", "S*"));
    EXPECT_FALSE(matches("W04", "????"));
    EXPECT_FALSE(matches("W04", ""));
}

Record record_of(std::uint64_t faults, std::uint64_t n, const char* variant = "") {
    Record record;
    record.n = n;
    record.faults = faults;
    record.pass = faults == 0;
    record.variant = variant;
    return record;
}

TEST(Schedule, TheLeastCertainRateCounts) {
    const std::vector<Record> records = {record_of(0, 1000), record_of(5, 100), record_of(0, 3, "control: fast")};
    const Interval widest = rate_interval_95(5, 100);
    EXPECT_EQ(uncertainty_of(records), (widest.high - widest.low) / 2);
    EXPECT_EQ(uncertainty_of({}), 0);
    Record measured = record_of(0, 2);
    measured.pass.reset();
    EXPECT_EQ(uncertainty_of(std::span(&measured, 1)), 0);
}

TEST(Schedule, TheLeastCertainCaseThatFitsIsImproved) {
    std::vector<CaseProgress> cases = {{.seconds = 1, .growth = 4, .uncertainty = 0.1},
                                       {.seconds = 2, .growth = 4, .uncertainty = 0.4},
                                       {.seconds = 9, .growth = 4, .uncertainty = 0.9}};
    EXPECT_EQ(next_to_improve(cases, 36), 2u);
    EXPECT_EQ(next_to_improve(cases, 35), 1u);
    EXPECT_EQ(next_to_improve(cases, 7), 0u);
    EXPECT_EQ(next_to_improve(cases, 3), std::nullopt);
    cases[1].can_improve = false;
    EXPECT_EQ(next_to_improve(cases, 35), 0u);
    cases[0].effort = 1;
    EXPECT_EQ(next_to_improve(cases, 35), std::nullopt);
}

TEST(Schedule, AStepThatTellsNoMoreIsTheLast) {
    const CaseProgress before{.effort = 0, .seconds = 2, .uncertainty = 0.1};
    const CaseProgress better = after_step(before, 10, 0.05), same = after_step(before, 10, 0.1);
    EXPECT_EQ(better.effort, effort_step);
    EXPECT_EQ(better.growth, 5);
    EXPECT_TRUE(better.can_improve);
    EXPECT_FALSE(same.can_improve);
}

TEST(Schedule, EachSectionHasItsTurn) {
    const std::string sections = "WWWSSP";
    EXPECT_EQ(by_turns(std::vector<char>(sections.begin(), sections.end())),
              (std::vector<std::size_t>{0, 3, 5, 1, 4, 2}));
}

TEST(SuiteState, IsReadAsItWasWritten) {
    const test::TempDir folder;
    const SuiteState state{folder / "progress.json", "0.1, a device", {{"W01", {0.25, 2, 3, 0.5, false}}}, 12.5};
    write_state(state);
    const SuiteState again = read_state(state.file, state.key);
    ASSERT_EQ(again.cases.size(), 1u);
    EXPECT_EQ(again.seconds, 12.5);
    const CaseProgress& progress = again.cases.at("W01");
    EXPECT_EQ(progress.effort, 0.25);
    EXPECT_EQ(progress.seconds, 2);
    EXPECT_EQ(progress.growth, 3);
    EXPECT_EQ(progress.uncertainty, 0.5);
    EXPECT_FALSE(progress.can_improve);
}

TEST(SuiteState, AnotherRunIsNotGoneOnWith) {
    const test::TempDir folder;
    write_state({folder / "progress.json", "0.1, a device", {}, 0});
    EXPECT_THROW(read_state(folder / "progress.json", "0.1, another device"), Error);
    EXPECT_THROW(read_state(folder / "nothing.json", "0.1, a device"), Error);
}

}  // namespace
}  // namespace twinray::suite
