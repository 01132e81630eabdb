// SPDX-License-Identifier: MIT
// Points of a timeline that commands will reach which are not submitted yet. Pure.
#pragma once

#include <cstdint>
#include <set>

namespace twinray {

// A timeline may only grow, so commands are submitted, or given up, in the order in which their points were promised.
class PromisedPoints {
  public:
    std::uint64_t promise() { return ++promised_; }
    // Returns whether no other commands are to be submitted before.
    bool is_due(std::uint64_t point) const { return point == passed_ + 1; }
    bool is_passed(std::uint64_t point) const { return point <= passed_; }
    std::uint64_t last_passed() const { return passed_; }
    // Returns the value that due commands signal: it includes those behind them that nobody will submit.
    std::uint64_t value_of(std::uint64_t point) const {
        while (given_up_.contains(point + 1)) ++point;
        return point;
    }
    void pass(std::uint64_t point) {
        passed_ = value_of(point);
        given_up_.erase(given_up_.begin(), given_up_.upper_bound(passed_));
    }
    void give_up(std::uint64_t point) {
        given_up_.insert(point);
        lost_.insert(point);
    }
    // Returns whether its commands were given up: work that relied on them never happened.
    bool is_lost(std::uint64_t point) const { return lost_.contains(point); }

  private:
    std::uint64_t promised_ = 0, passed_ = 0;
    std::set<std::uint64_t> given_up_;  // not passed yet
    std::set<std::uint64_t> lost_;
};

}  // namespace twinray
