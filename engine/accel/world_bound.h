// SPDX-License-Identifier: MIT
// WorldBound for C++, and its computation on the GPU.
#pragma once

#include "engine/accel/instance_record.h"
#include "engine/core/kernel.h"
#include "engine/core/ray.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/world_bound.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(WorldBound) == 32 && sizeof(WorldBoundBits) == 32);

// Computes the box around an accelerator's instances in each of its syncs.
class WorldBoundKernel {
  public:
    explicit WorldBoundKernel(Context& context);

    // Over `count` records, whose geometry blocks hold their boxes already.
    void record(Commands& commands, Ref<InstanceRecord> records, uint count) const;

    // On the device, since the last record().
    Ref<WorldBound> result() const { return result_.ref<WorldBound>(); }
    // The same on the host, once the commands given to the last record() are done.
    WorldBound read() const;

  private:
    Kernel<WorldBoundArgs> kernel_;
    Buffer result_, bits_, readback_;
};

}  // namespace twinray
