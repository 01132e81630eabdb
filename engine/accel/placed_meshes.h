// Meshes and the instances that place them, as analyses, collisions and distances read them on the host: in place.
#pragma once

#include <vector>

#include <twinray/abstract_accel.h>
#include <twinray/scene.h>

#include "engine/accel/mesh_store.h"

namespace twinray {

class PlacedMeshes {
  public:
    PlacedMeshes() = default;
    // The scene must outlive it.
    PlacedMeshes(const Scene& scene);
    // Takes what an accelerator holds after a sync: see scene_of().
    explicit PlacedMeshes(AbstractAccel& accel);
    // The arrays that the views refer to must outlive it.
    PlacedMeshes(std::span<const MeshView> some_meshes, std::span<const MeshInstance> some_instances)
        : meshes(some_meshes.begin(), some_meshes.end()), instances(some_instances.begin(), some_instances.end()) {}
    PlacedMeshes(PlacedMeshes&&) noexcept = default;
    PlacedMeshes& operator=(PlacedMeshes&&) noexcept = default;

    const MeshView& mesh_of(uint instance) const { return meshes[instances[instance].mesh]; }
    // Returns some of the meshes, by index. An accelerator of this device, which must be there unchanged, lends them;
    // the others are uploaded.
    std::vector<MeshOnDevice> on_device(Commands& commands, std::span<const uint> some) const;

    std::vector<MeshView> meshes;
    std::vector<MeshInstance> instances;

  private:
    std::vector<SharedMesh> owned_;     // the data that the views of an accelerator's meshes refer to
    std::vector<AccelHandle> handles_;  // handles of these meshes
    AbstractAccel* accel_ = nullptr;
};

// Returns the number of triangles of each instance.
std::vector<std::size_t> triangle_counts(const PlacedMeshes& placed);

}  // namespace twinray
