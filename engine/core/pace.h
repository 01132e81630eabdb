// SPDX-License-Identifier: MIT
// How much work a submission may have: drivers reset a GPU that is busy with one for too long.
#pragma once

#include <cstdint>

#include <twinray/commands.h>

namespace twinray {

// Items of work, a ray, a point or a pair of boxes each, and how long the device was busy with them.
struct MeasuredWork {
    std::uint64_t items = 0;
    double seconds = 0;
};

// How many items a submission may have before any is measured: what takes a quarter of `most_seconds` where a device
// does 2^17 in a second. As all counts of items here a multiple of 64, which is the least.
std::uint64_t first_items(double most_seconds);

// How many the one after `last` may have, which might have had `allowed`: as many as take a quarter of `most_seconds`
// at its rate, since the next ones may take longer each; at most 4 times as many as it had, since small work is no
// measure of large work. A last one that had fewer than allowed and was quick says nothing: as many as before.
std::uint64_t next_items(std::uint64_t allowed, const MeasuredWork& last, double most_seconds);

// How many groups of passes that nobody measures, of little work per invocation, may share a submission: a quarter of
// what takes `most_seconds` at 2^17 groups a second. Any number where that is 0.
std::uint64_t most_groups(double most_seconds);

}  // namespace twinray
