// SPDX-License-Identifier: MIT
#include <twinray/analysis.h>

#include <gtest/gtest.h>

#include <fstream>

#include "engine/core/error.h"

namespace twinray {
namespace {

class RowFileTest : public ::testing::Test {
  protected:
    RowFileTest() { std::filesystem::remove(file_); }
    ~RowFileTest() override { std::filesystem::remove(file_); }

    static std::vector<ViewFactorRow> some_rows(uint count) {
        std::vector<ViewFactorRow> rows;
        for (uint i = 0; i < count; ++i) {
            ViewFactorRow row{i, 100 + i, {}, 7, {0.5, {0.25, 0.75}}, {0.125, {0, 1}}};
            for (uint j = 0; j < i; ++j) row.factors.push_back({j, 0.5f, 0.25f, 1.0f / static_cast<float>(j + 1)});
            rows.push_back(row);
        }
        return rows;
    }
    void write(uint count) {
        RowFile file(file_, "options");
        file.create();
        file.append(some_rows(count));
    }
    std::size_t loaded() { return RowFile(file_, "options").load().size(); }

    std::filesystem::path file_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("rows_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(RowFileTest, GivesBackWhatWasAppended) {
    write(5);
    const std::vector<ViewFactorRow> rows = RowFile(file_, "options").load(), expected = some_rows(5);
    ASSERT_EQ(rows.size(), 5u);
    for (uint i = 0; i < 5; ++i) {
        EXPECT_EQ(rows[i].group, i);
        EXPECT_EQ(rows[i].rays, expected[i].rays);
        EXPECT_EQ(rows[i].open.interval_95, expected[i].open.interval_95);
        EXPECT_EQ(rows[i].back.value, expected[i].back.value);
        ASSERT_EQ(rows[i].factors.size(), i);
        for (uint j = 0; j < i; ++j) EXPECT_EQ(rows[i].factors[j].high, expected[i].factors[j].high);
    }
}

TEST_F(RowFileTest, ARowThatWasCutShortIsLeftOutAndWrittenOver) {
    write(5);
    const std::uint64_t whole = std::filesystem::file_size(file_);
    for (const std::uint64_t missing : {1, 30, 80}) {
        write(5);
        std::filesystem::resize_file(file_, whole - missing);
        RowFile file(file_, "options");
        ASSERT_EQ(file.load().size(), 4u) << missing << " bytes are missing";
        const std::vector<ViewFactorRow> all = some_rows(5);
        file.append(std::span(all).last(1));
        EXPECT_EQ(std::filesystem::file_size(file_), whole);
        EXPECT_EQ(loaded(), 5u);
    }
}

TEST_F(RowFileTest, DamageEndsWhatIsRead) {
    write(5);
    std::fstream stream(file_, std::ios::binary | std::ios::in | std::ios::out);
    stream.seekp(-60, std::ios::end);
    stream.put('?');
    stream.close();
    EXPECT_EQ(loaded(), 4u);
}

TEST_F(RowFileTest, OtherOptionsAreRefused) {
    write(2);
    EXPECT_THROW(RowFile(file_, "other options").load(), Error);
    EXPECT_EQ(loaded(), 2u) << "and nothing is lost";
}

TEST_F(RowFileTest, WithoutAFileItBegins) {
    EXPECT_EQ(loaded(), 0u);
    EXPECT_TRUE(std::filesystem::exists(file_));
}

}  // namespace
}  // namespace twinray
