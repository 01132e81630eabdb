// Converts callers' meshes in device memory into the form that accelerators build from.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "engine/accel/geometry.h"
#include "engine/core/kernel.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/gather_mesh.h"
#include "twinray/glsl/cpp_end.h"

// Throws Error naming the mesh and its invalid part: an address, a stride, a count.
void check_device_mesh(const DeviceMesh& mesh);
// Returns whether it is packed already.
bool is_packed(const DeviceMesh& mesh);

class MeshGather {
  public:
    explicit MeshGather(Context& context);

    struct Item {
        const DeviceMesh* mesh;
        std::string name;
        float scale;  // the unit of the resulting positions
        PackedMesh target;
    };
    // The faults that were counted in the meshes of one sync.
    struct Faults {
        std::vector<std::string> names;
        Buffer counts;
    };
    Faults record(Commands& commands, std::span<const Item> items) const;
    void commit(Faults&& faults, SyncPoint done);
    // Warns of triangles with an index out of range, from syncs that the GPU is done with.
    void warn_of_faults(const std::string& accel);

  private:
    Context& context_;
    Kernel<GatherMeshArgs> kernel_;
    std::vector<std::pair<SyncPoint, Faults>> untold_;
    std::map<std::string, uint> told_;  // by mesh: how many faults the last warning named
};

}  // namespace twinray
