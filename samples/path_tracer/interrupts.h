// SPDX-License-Identifier: MIT
// Signals that end a render in good order.
#pragma once

namespace twinray::path_tracer {

// While it lives, the first SIGINT or SIGTERM is only noted, so that work can end in good order; a second one ends the
// program at once. One at a time.
class Interrupts {
  public:
    Interrupts();
    ~Interrupts();
    Interrupts(const Interrupts&) = delete;
    Interrupts& operator=(const Interrupts&) = delete;

    // The number of the signal; 0: none came.
    int signal() const;
};

}  // namespace twinray::path_tracer
