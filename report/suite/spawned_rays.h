// SPDX-License-Identifier: MIT
// Rays that a kernel lets leave points of a mesh, by the function that users call.
#pragma once

#include "report/suite/devices.h"
#include "twinray/glsl/cpp_spawn.h"
#include "engine/core/kernel.h"
#include "engine/scene/mesh.h"

namespace twinray::suite {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/suite/spawn_args.h"
#include "twinray/glsl/cpp_end.h"

struct SpawnedRays {
    std::vector<Ray> rays;           // of every method, one an item
    std::vector<SpawnPrice> prices;  // of the items by SPAWN_BOUND
};

// Compiled once; the same rays for all accelerators, as the kernel traces nothing.
class Spawner {
  public:
    explicit Spawner(Context& context);
    SpawnedRays operator()(const Mesh& mesh, const Transform& instance, std::span<const SpawnItem> items) const;

  private:
    Context& context_;
    Kernel<SpawnArgs> kernel_;
};

}  // namespace twinray::suite
