// WorldBound for C++, and its computation on the GPU.
#pragma once

#include "engine/core/kernel.h"
#include "engine/core/ray.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/world_bound.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(WorldBound) == 32 && sizeof(WorldBoundBits) == 32);

// Computes the box around an accelerator's instances.
class WorldBoundKernel {
  public:
    explicit WorldBoundKernel(Context& context);

    // Covers `count` records, whose geometry blocks hold their boxes already.
    void record(Commands& commands, Ref<InstanceRecord> records, uint count) const;

    // Returns it on the device, as of the last record().
    Ref<WorldBound> result() const { return result_.ref<WorldBound>(); }
    // Returns it on the host, once the commands given to the last record() are done.
    WorldBound read() const;

  private:
    Kernel<WorldBoundArgs> kernel_;
    Buffer result_, bits_, readback_;
};

// The box around the instances of one sync, which is computed when it is first requested.
class BoundOfSync {
  public:
    // The geometry blocks of the `count` records hold their boxes by the time the commands run. is_there: earlier
    // commands have computed the bound.
    BoundOfSync(const WorldBoundKernel& kernel, Commands& commands, Ref<InstanceRecord> records, std::size_t count,
                bool is_there = false)
        : kernel_(kernel),
          commands_(commands),
          records_(records),
          count_(static_cast<uint>(count)),
          is_there_(is_there) {}

    Ref<WorldBound> on_device();
    bool is_there() const { return is_there_; }

  private:
    const WorldBoundKernel& kernel_;
    Commands& commands_;
    Ref<InstanceRecord> records_;
    uint count_;
    bool is_there_;
};

}  // namespace twinray
