// SPDX-License-Identifier: MIT
// Reports to the host the invalid accesses of kernels compiled with TWINRAY_DEBUG.
#pragma once

#include <cstring>

#include "engine/core/commands.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/faults.h"
#include "twinray/glsl/cpp_end.h"

class FaultLog {
  public:
    explicit FaultLog(Context& context, const std::string& name)
        : buffer_(context, {.name = "faults of " + name, .bytes = sizeof(Faults), .memory = Memory::readback}) {
        clear();
    }

    Ref<Faults> on_device() const { return buffer_.ref<Faults>(); }
    // Returns the faults noted by kernels that the GPU is done with.
    Faults read() const {
        Faults faults;
        std::memcpy(&faults, buffer_.mapped(), sizeof faults);
        return faults;
    }
    // No kernel that may write may run meanwhile.
    void clear() { std::memset(buffer_.mapped(), 0, sizeof(Faults)); }

  private:
    Buffer buffer_;
};

}  // namespace twinray
