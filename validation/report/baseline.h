// SPDX-License-Identifier: MIT
// A report compared with an older one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "validation/records/record.h"

namespace twinray::report {

// Something that got worse since an older report.
struct Change {
    std::string what;        // "W04 sw watertight {aim vertex}"
    std::string how;         // "ns_per_ray 410 -> 460 (+12 %), outside the spread", "SW_LEAK 0 -> 3 of 8192"
    bool is_slower = false;  // else a class count, a result, or a case that runs no longer

    bool operator==(const Change&) const = default;
};

// Compares records of the same case, parameters, backend, level and variant.
//   slower: the median time is more than 5 % larger, and the 95 % intervals of the medians do not overlap, both after
//   what all times have in common (the median of the ratios, from 8 measurements on) is taken out: a machine that is
//   busier or a build that is slower altogether is one change of its own;
//   worse: the rate of any class but AGREE and TIE is larger, or of faults, or it passed and does not, or it was run
//   and is not. Of negative controls, whose faults are wanted, only the result counts.
// Times are compared where both ran on the same device and driver.
std::vector<Change> worse_than(std::span<const Record> baseline, std::span<const Record> now);
// How many of `now` have such a record in the baseline.
std::size_t count_comparable(std::span<const Record> baseline, std::span<const Record> now);

}  // namespace twinray::report
