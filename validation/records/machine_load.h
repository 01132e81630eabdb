// SPDX-License-Identifier: MIT
// How busy other programs keep the processors while something is timed.
#pragma once

#include <optional>

namespace twinray {

class MachineLoad {
  public:
    MachineLoad();  // from now on

    // Seconds of all processors together since then; nothing where the system does not tell (/proc/stat).
    std::optional<double> seconds() const;
    // The share of them, 0 to 1, that other programs than this one and its children took.
    std::optional<double> of_others() const;

  private:
    struct Times {
        double all = 0, busy = 0, own = 0;  // seconds
    };
    static std::optional<Times> now();

    std::optional<Times> start_;
};

}  // namespace twinray
