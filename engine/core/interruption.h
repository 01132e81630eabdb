// SPDX-License-Identifier: MIT
// Long work on the host and waits for the device look whether their caller wants them to end: InterruptScope.
#pragma once

#include <cstddef>

#include <twinray/geometry.h>

namespace twinray {

inline constexpr double seconds_between_looks = 0.1;

// Whether an InterruptScope of this thread lives.
bool is_interruptible() noexcept;

// For loops of short turns: looks in each 1024th.
class LoopInterruption {
  public:
    void look() {
        if (++turns_ % 1024 == 0) look_for_interruption();
    }

  private:
    std::size_t turns_ = 0;
};

}  // namespace twinray
