// SPDX-License-Identifier: MIT
// How often each accelerator makes each mistake: pure functions of a report's records.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "validation/records/record.h"

namespace twinray::report {

// A way to be wrong, over all cases that can show it.
enum class Mistake : std::uint8_t { leak, false_hit, wrong_distance, not_finite, counted_wrong };
inline constexpr std::array all_mistakes = {Mistake::leak, Mistake::false_hit, Mistake::wrong_distance,
                                            Mistake::not_finite, Mistake::counted_wrong};
std::string_view name_of(Mistake mistake);  // "rays lost at edges and vertices"

// Rays of one case and kind.
struct RayKind {
    std::string case_id, settings;  // "W04", "aim vertex, cells 64"
    std::uint64_t faults = 0, n = 0;
};

// How often who answers makes a mistake. Each ray counts once: levels trace the same rays, so it is of one of those
// that promise not to, the one with the most faults (the first of equals).
struct Finding {
    std::string backend, level;
    Mistake mistake = Mistake::leak;
    std::vector<RayKind> kinds = {};       // of the cases that it rests on
    std::vector<RayKind> elsewhere = {};   // of other cases, with faults alone
    std::size_t cases_run = 0, cases = 0;  // of those that it rests on

    bool is_complete() const { return cases_run == cases; }
    bool has_faults() const;
    std::uint64_t n() const;  // rays of `kinds`
    // Over the cases, each counted as one, and so its kinds of rays; one number, however thoroughly each was asked.
    double rate() const;
    Interval rate_95() const;
};
// The finding of one level, which may be "fast".
Finding finding_at(std::span<const Record> records, std::string_view backend, std::string_view level, Mistake mistake);
// One for each mistake that a backend among the records was checked for.
std::vector<Finding> findings_of(std::span<const Record> records);
// "0.27 % (0.25 to 0.3) over 17 cases; most in W04, 4.6 % (4.2 to 5)", "0 of 230,000 rays, 17 cases (below ...)".
std::string text_of(const Finding& finding);

}  // namespace twinray::report
