// SPDX-License-Identifier: MIT
#include "engine/core/pace.h"
#include "engine/core/context.h"
#include "engine/core/interruption.h"

#include <algorithm>

namespace twinray {
namespace {

constexpr double aimed_share = 0.25;  // of the most seconds, which a submission aims at
constexpr double most_growth = 4;
constexpr double most_interruptible_seconds = 2;
constexpr std::uint64_t fewest_items = 64;
constexpr double slowest_items_per_second = 1 << 17, slowest_groups_per_second = 1 << 17;

std::uint64_t whole_groups(double items) {
    constexpr double most = 0x1p63;
    return std::max(static_cast<std::uint64_t>(std::min(items, most)) / fewest_items, std::uint64_t{1}) * fewest_items;
}

double most_seconds(double of_device, bool is_interruptible) {
    return is_interruptible && of_device == 0 ? most_interruptible_seconds : of_device;
}

}  // namespace

std::uint64_t first_items(double most_seconds) {
    return whole_groups(slowest_items_per_second * most_seconds * aimed_share);
}

std::uint64_t next_items(std::uint64_t allowed, const MeasuredWork& last, double most_seconds) {
    const double aim = most_seconds * aimed_share;
    if (last.items < allowed && last.seconds <= aim) return allowed;
    const auto items = static_cast<double>(last.items);
    // The queue's clock may be too coarse for it.
    return whole_groups(last.seconds * most_growth > aim ? items * aim / last.seconds : items * most_growth);
}

std::uint64_t most_groups(double most_seconds) {
    if (most_seconds == 0) return UINT64_MAX;
    return static_cast<std::uint64_t>(slowest_groups_per_second * most_seconds * aimed_share);
}

// A caller who may want to end the work does not want to wait for submitted work either.
Pace::Pace(const Context& context)
    : most_seconds_(most_seconds(context.state().tuning().most_submission_seconds, is_interruptible())),
      allowed_(first_items(most_seconds_)) {}

std::uint64_t Pace::next(std::uint64_t left) const { return most_seconds_ == 0 ? left : std::min(left, allowed_); }

void Pace::took(double seconds) { allowed_ = next_items(allowed_, {pending_, seconds}, most_seconds_); }

void Pace::finish(Commands& commands) {
    const double seconds = commands.submit_and_wait();
    if (pending_ > 0) took(seconds);
    pending_ = 0;
}

}  // namespace twinray
