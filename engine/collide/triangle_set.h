// Triangles of instances on the device, for searches by boxes.
#pragma once

#include <span>
#include <vector>

#include "engine/accel/placed_meshes.h"
#include "engine/collide/box_tree.h"
#include "engine/collide/pair_class.h"
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

    // `chosen`: indices of the instances that take part, ascending. The data that the views refer to must outlive the
    // use of this.
    void set(const PlacedMeshes& placed, std::span<const uint> chosen, SharedVertices shared);
    std::size_t count() const { return count_; }
    // Writes triangles and names of all, and builds a tree of their boxes, which are grouped by instance. The meshes
    // themselves are not needed after that.
    void build(BoxTree& tree);
    Ref<WorldTriangle> triangles_on_device() const { return world_triangles_.ref<WorldTriangle>(); }
    Ref<TriangleName> names_on_device() const { return names_.ref<TriangleName>(); }
    Ref<TriangleRun> runs_on_device() const { return table_.ref<TriangleRun>(); }  // by group of the boxes

    // Computes one item on the host: the same bits.
    WorldTriangle triangle(uint item) const;
    TriangleName name(uint item) const;
    uint instance(uint item) const { return chosen_[run_of(item)]; }
    uint primitive(uint item) const { return item - runs_[run_of(item)].first_triangle; }
    bool is_mirrored(uint item) const { return runs_[run_of(item)].is_mirrored != 0; }
    std::uint64_t bytes() const {
        return vertex_ids_on_device_.bytes() + table_.bytes() + world_triangles_.bytes() + names_.bytes();
    }

  private:
    void clear();
    std::vector<Uints> upload_vertex_ids(Commands& commands);
    std::size_t run_of(uint item) const;

    Context& context_;
    Kernel<WorldTrianglesArgs> kernel_;
    std::vector<TriangleRun> runs_;              // with addresses of the host
    std::vector<MeshOnDevice> meshes_;           // the meshes that take part, until build()
    std::vector<std::vector<uint>> vertex_ids_;  // by mesh, unless they are the indices
    std::vector<uint> chosen_;
    std::size_t count_ = 0;
    Buffer vertex_ids_on_device_, table_, world_triangles_, names_;
};

}  // namespace twinray
