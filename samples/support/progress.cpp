// SPDX-License-Identifier: MIT
#include "samples/support/progress.h"

#include <algorithm>
#include <cstdio>

#include "engine/core/platform.h"

namespace twinray::samples {
namespace {

constexpr int width = 30;
constexpr std::chrono::milliseconds interval{100};

}  // namespace

Progress::Progress(std::string label, std::uint64_t total, bool quiet)
    : label_(std::move(label)),
      total_(std::max<std::uint64_t>(total, 1)),
      enabled_(!quiet && platform::is_error_terminal()) {}

Progress::~Progress() {
    if (shown_) std::fprintf(stderr, "\r\033[K");
}

void Progress::advance(std::uint64_t steps) {
    done_ = std::min(done_ + steps, total_);
    const Clock::time_point now = Clock::now();
    if (!enabled_ || now - start_ < std::chrono::seconds(1) || now - last_ < interval) return;
    last_ = now;
    shown_ = true;
    const double fraction = static_cast<double>(done_) / static_cast<double>(total_);
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const int filled = static_cast<int>(fraction * width);
    std::fprintf(stderr, "\r%s [%.*s%*s] %3.0f %%, %.0f s left\033[K", label_.c_str(), filled,
                 "##############################", width - filled, "", 100 * fraction,
                 fraction > 0 ? elapsed / fraction - elapsed : 0.0);
    std::fflush(stderr);
}

}  // namespace twinray::samples
