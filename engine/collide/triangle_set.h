// SPDX-License-Identifier: MIT
// Triangles of instances on the device, for searches by boxes.
#pragma once

#include <span>
#include <vector>

#include "engine/collide/pair_class.h"
#include "engine/core/kernel.h"
#include <twinray/geometry.h>
#include "engine/scene/mesh.h"

namespace twinray {

// Throws Error, beginning with `action`, that names the mesh or the instance with an index out of range.
void check_instances(std::span<const MeshView> meshes, std::span<const MeshInstance> instances, const char* action);

// Returns a box around an instance in world space, with vertices as in world_vertex.h, and a little more. Empty for a
// mesh without a finite triangle.
TreeBox box_of_instance(const Bounds& mesh, const Transform& transform, uint item);

// The triangles of instances in world space, on the device: item i counts them instance by instance.
class TriangleSet {
  public:
    explicit TriangleSet(Context& context);

    // Uploads the meshes. `chosen`: indices of the instances that take part, ascending. The spans, and the data that
    // they refer to, must outlive the use of this.
    void set(std::span<const MeshView> meshes, std::span<const MeshInstance> instances, std::span<const uint> chosen,
             SharedVertices shared);
    std::size_t count() const { return count_; }
    // Writes boxes, triangles and names of all; items are grouped by instance.
    void record(Commands& commands, Ref<TreeBox> boxes) const;
    Ref<WorldTriangle> triangles_on_device() const { return world_triangles_.ref<WorldTriangle>(); }
    Ref<TriangleName> names_on_device() const { return names_.ref<TriangleName>(); }
    Ref<InstancedMesh> meshes_on_device() const { return table_.ref<InstancedMesh>(); }  // by group of the boxes

    // Computes one item on the host: the same bits.
    WorldTriangle triangle(uint item) const;
    TriangleName name(uint item) const;
    uint instance(uint item) const { return chosen_[mesh_of(item)]; }
    uint primitive(uint item) const { return item - instanced_[mesh_of(item)].first_triangle; }
    bool is_mirrored(uint item) const { return instanced_[mesh_of(item)].is_mirrored != 0; }
    std::uint64_t bytes() const { return data_.bytes() + table_.bytes() + world_triangles_.bytes() + names_.bytes(); }

  private:
    void allocate(std::uint64_t mesh_bytes);
    std::size_t mesh_of(uint item) const;

    Context& context_;
    Kernel<WorldTrianglesArgs> kernel_;
    std::vector<InstancedMesh> instanced_;       // with addresses of the host
    std::vector<std::vector<uint>> vertex_ids_;  // by mesh, where they are not the indices
    std::vector<uint> chosen_;
    std::size_t count_ = 0;
    Buffer data_, table_, world_triangles_, names_;
};

}  // namespace twinray
