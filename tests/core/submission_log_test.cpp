// SPDX-License-Identifier: MIT
// What the error of a lost device says.
#include "engine/core/submission_log.h"

namespace twinray {
namespace {

TEST(SubmissionLog, WhatIsDoneIsNotTold) {
    SubmissionLog work;
    EXPECT_EQ(work.sentence(), "");
    work.submitted(1, "sync", {{"swtlas_morton", 7}, {"sort_scan", 1}});
    work.submitted(2, "trace", {{"swtlas_trace closest", 625}});
    EXPECT_EQ(work.sentence(),
              "; in flight: 'sync' (2 passes: 'swtlas_morton' of 7 groups, 'sort_scan' of 1 groups), 'trace' (1 pass: "
              "'swtlas_trace closest' of 625 groups)");
    work.reached(1);
    EXPECT_EQ(work.sentence(), "; in flight: 'trace' (1 pass: 'swtlas_trace closest' of 625 groups)");
    work.reached(2);
    EXPECT_EQ(work.sentence(), "");
}

TEST(SubmissionLog, LargePassesComeFirstAndTheRestIsCounted) {
    SubmissionLog work;
    work.submitted(1, "a", {{"copy", 0}, {"small", 1}, {"large", 9}, {"middle", 5}});
    for (std::uint64_t value = 2; value < 6; ++value) work.submitted(value, "b", {{"copy", 0}});
    EXPECT_EQ(
        work.sentence(),
        "; in flight: 'a' (4 passes: 'large' of 9 groups, 'middle' of 5 groups, 'small' of 1 groups, ...), 'b' (1 "
        "pass: 'copy'), 'b' (1 pass: 'copy'), and 2 more");
}

}  // namespace
}  // namespace twinray
