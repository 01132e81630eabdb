// SPDX-License-Identifier: MIT
// Progress on a terminal.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <utility>

namespace twinray::samples {

// A bar with the remaining time on stderr. It is silent if stderr is not a terminal, if `quiet`, and during the first
// second, so that short work leaves no trace.
class Progress {
  public:
    Progress(std::string label, std::uint64_t total, bool quiet);
    ~Progress();  // erases the bar
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void advance(std::uint64_t steps = 1);
    void rename(std::string label) { label_ = std::move(label); }  // as shown from the next step on

  private:
    using Clock = std::chrono::steady_clock;
    std::string label_;
    std::uint64_t total_;
    std::uint64_t done_ = 0;
    bool enabled_;
    bool shown_ = false;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_ = start_;
};

}  // namespace twinray::samples
