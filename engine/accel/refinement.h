// The device data of Level::refined: all transforms as they were given, with the addresses of meshes.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/accel/world_bound.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/exact_hit.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(RefineInstance) == 176 && sizeof(RefineScene) == 16);

class Refinement {
  public:
    explicit Refinement(Context& context);

    // Records the commands that take over these instances, whose blocks have their GeometrySource. Returns memory to be
    // committed once they are certain to run, if it needed more or far less.
    std::optional<Buffer> stage(Commands& commands, Ref<InstanceRecord> records, std::size_t count,
                                Ref<WorldBound> bound) const;
    void commit(std::optional<Buffer>&& instances);

    // Waits. Returns the float64 results for hits of the last sync; entries of misses are not written.
    std::vector<HitDouble> exact(std::span<const Ray64> rays, std::span<const Hit> hits) const;

    Ref<RefineScene> scene() const { return scene_.ref<RefineScene>(); }
    std::uint64_t bytes() const { return scene_.bytes() + instances_.bytes(); }

  private:
    Context& context_;
    Kernel<RefineGatherArgs> gather_;
    Kernel<ExactHitsArgs> exact_hits_;
    Buffer scene_, instances_;
};

}  // namespace twinray
