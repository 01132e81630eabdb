// SPDX-License-Identifier: MIT
// How much work a submission may have: drivers reset a GPU that is busy with one for too long.
#pragma once

#include <cstdint>

#include "engine/core/commands.h"

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

// Cuts work of one kind into submissions of less than KernelTuning::most_submission_seconds each, by how long the ones
// before took. Results must not depend on where it cuts. Remembers the rate from one use to the next.
class Pace {
  public:
    explicit Pace(const Context& context);

    // Has `record(first, count)` record all of `count` items in order, in as many parts as it takes: all but the last
    // are submitted and waited for, with what the commands held before. Commands of the caller stay whole.
    template <class Record>
    void record(Commands& commands, std::uint64_t count, const Record& record) {
        for (std::uint64_t first = 0; first < count; first += pending_) {
            if (first > 0) took(commands.submit_part());
            pending_ = commands.is_of_caller() ? count : next(count - first);
            record(first, pending_);
        }
    }
    // Submits the last part, waits for it and learns from it.
    void finish(Commands& commands);

  private:
    std::uint64_t next(std::uint64_t left) const;
    void took(double seconds);

    double most_seconds_;  // 0: no limit
    std::uint64_t allowed_;
    std::uint64_t pending_ = 0;  // items that are recorded
};

}  // namespace twinray
