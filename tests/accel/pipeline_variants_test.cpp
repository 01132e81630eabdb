// SPDX-License-Identifier: MIT
// Which program serves while others are compiled.
#include "engine/accel/pipeline_variants.h"

#include <gtest/gtest.h>

#include <atomic>
#include <semaphore>

#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr uint all_programs = 7;

class PipelineVariantsTest : public ::testing::Test {
  protected:
    // Compiles while it holds `gate`; features 4 cannot be compiled.
    class Program : public TraceProgram {
      public:
        Program(PipelineVariantsTest& test, uint features) : TraceProgram(1, features, "test"), test_(test) {}
        void prepare(Query, Level) const override {
            test_.gate.acquire();
            test_.gate.release();
            if (features() == 4) fail("cannot be compiled");
            ++test_.compiled;
        }
        void record(Commands&, const TraceArgs&, Query, Level) const override {}

      private:
        PipelineVariantsTest& test_;
    };

    std::unique_ptr<PipelineVariants> make(bool in_background) {
        return std::make_unique<PipelineVariants>(
            [this](uint features) { return std::make_unique<Program>(*this, features); }, all_programs, in_background);
    }
    // With the program for features 1, and the general one.
    std::unique_ptr<PipelineVariants> make_with_both() {
        std::unique_ptr<PipelineVariants> programs = make(true);
        for (int i = 0; i < 2; ++i) serving(*programs, 1);
        programs->wait();
        return programs;
    }
    static uint serving(PipelineVariants& programs, uint features, Query query = Query::closest) {
        return programs.get(features, query, Level::watertight).features();
    }

    std::counting_semaphore<> gate{1};
    std::atomic<int> compiled = 0;
};

TEST_F(PipelineVariantsTest, TheFirstTraceHasTheProgramThatFitsAndTheSecondWantsTheGeneralOne) {
    const auto programs = make(true);
    EXPECT_EQ(serving(*programs, 1), 1u);
    programs->wait();
    EXPECT_EQ(compiled, 1);
    for (int i = 0; i < 2; ++i) EXPECT_EQ(serving(*programs, 1), 1u);
    programs->wait();
    EXPECT_EQ(compiled, 2);
}

TEST_F(PipelineVariantsTest, TheGeneralOneServesUntilTheLeanOneIsThere) {
    const auto programs = make_with_both();
    gate.acquire();
    EXPECT_EQ(serving(*programs, 2), all_programs);
    EXPECT_EQ(serving(*programs, 2), all_programs);
    EXPECT_EQ(serving(*programs, 1), 1u) << "is there already";
    gate.release();
    programs->wait();
    EXPECT_EQ(serving(*programs, 2), 2u);
    EXPECT_EQ(compiled, 3);
    EXPECT_EQ(serving(*programs, 2, Query::any), 2u) << "first of its kind";
}

TEST_F(PipelineVariantsTest, WithoutABackgroundEachTraceWaits) {
    const auto programs = make(false);
    for (const uint features : {1u, 2u, all_programs}) EXPECT_EQ(serving(*programs, features), features);
    EXPECT_EQ(compiled, 3);
}

TEST_F(PipelineVariantsTest, WhatFailsInTheBackgroundIsNeverServed) {
    const auto programs = make(true);
    EXPECT_THROW(serving(*programs, 4), Error) << "no other is there";
    for (int i = 0; i < 2; ++i) serving(*programs, 1);
    programs->wait();
    EXPECT_EQ(serving(*programs, 4), all_programs);
    programs->wait();
    EXPECT_EQ(serving(*programs, 4), all_programs);
}

TEST_F(PipelineVariantsTest, TheEndWaitsForTheOneThatIsBeingCompiledAlone) {
    auto programs = make_with_both();
    gate.acquire();
    serving(*programs, 2);
    serving(*programs, 3);
    std::thread release([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        gate.release();
    });
    programs.reset();
    release.join();
    EXPECT_LE(compiled, 3);
}

}  // namespace
}  // namespace twinray
