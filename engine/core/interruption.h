// Lets long work on the host, and waits for the device, end early if their caller wants it: InterruptScope.
#pragma once

#include <cstddef>

#include <twinray/geometry.h>

namespace twinray {

inline constexpr double seconds_between_looks = 0.1;

// Returns whether this thread has a live InterruptScope.
bool is_interruptible() noexcept;

// Looks in every 1024th turn, for loops of short turns.
class LoopInterruption {
  public:
    void look() {
        if (++turns_ % 1024 == 0) look_for_interruption();
    }

  private:
    std::size_t turns_ = 0;
};

}  // namespace twinray
