// SPDX-License-Identifier: MIT
// Limits the work of a submission: drivers reset a GPU that is busy with one for too long.
#pragma once

#include <cstdint>

#include <twinray/commands.h>

namespace twinray {

// A number of items of work, each a ray, a point or a pair of boxes, and how long the device was busy with them.
struct MeasuredWork {
    std::uint64_t items = 0;
    double seconds = 0;
};

// Returns the number of items of a submission before any is measured: a quarter of `most_seconds` if a device does 2^17
// items in a second. It is a multiple of 64, like all counts of items here, and at least 64.
std::uint64_t first_items(double most_seconds);

// Returns the number of items after `last`, which could have had `allowed`: as many as take a quarter of `most_seconds`
// at its rate, since the next ones may take longer each; at most 4 times as many as it had, since small work is no
// measure of large work. If the last one had fewer than allowed and was quick, the number stays.
std::uint64_t next_items(std::uint64_t allowed, const MeasuredWork& last, double most_seconds);

// Returns the number of groups of passes that nobody measures, of little work per invocation, that may share a
// submission: a quarter of the groups that take `most_seconds` at 2^17 per second. No limit if that is 0.
std::uint64_t most_groups(double most_seconds);

}  // namespace twinray
