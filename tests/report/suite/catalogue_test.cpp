// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "report/suite/suite.h"

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

}  // namespace
}  // namespace twinray::suite
