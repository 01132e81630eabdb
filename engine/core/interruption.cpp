#include "engine/core/interruption.h"

#include <chrono>

namespace twinray {
namespace {

using Clock = std::chrono::steady_clock;

thread_local InterruptScope* innermost = nullptr;
thread_local Clock::time_point next_look;

}  // namespace

InterruptScope::InterruptScope(std::function<bool()> goes_on)
    : goes_on_(std::move(goes_on)), outer_(std::exchange(innermost, this)) {
    next_look = {};
}

InterruptScope::~InterruptScope() { innermost = outer_; }

bool is_interruptible() noexcept { return innermost != nullptr; }

void look_for_interruption() {
    if (!innermost || Clock::now() < next_look) return;
    const bool goes_on = innermost->goes_on_();
    next_look = Clock::now() +
                std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds_between_looks));
    if (!goes_on) throw Interrupted();
}

}  // namespace twinray
