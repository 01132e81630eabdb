// The software accelerator on the host: built and traversed serially, to compare kernels with and to step through.
#pragma once

#include <twinray/scene.h>

#include "engine/accel/geometry.h"
#include "engine/accel/refinement.h"
#include "validation/cpu_reference/reference.h"

namespace twinray::reference {

// A whole software accelerator in host memory: what the GPU builds and traverses, step by step in a debugger. Its hits
// are those of SwTlas to the last bit, where the device divides and adds as IEEE 754 does.
class Scene {
  public:
    explicit Scene(Layout layout = AccelOptions{}.layout, BuildQuality quality = AccelOptions{}.build_quality)
        : layout_(layout), quality_(quality) {}
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;

    // Returns the geometry's index. Throws as Geometry does.
    std::size_t add_geometry(const MeshView& mesh);
    void add_instance(std::size_t geometry, const InstanceRecord& record);
    void build();
    // Threads may share it once it is built. level: LEVEL_*.
    Hit trace(const Ray& ray, uint query = QUERY_CLOSEST, uint mask = 0xff, uint level = LEVEL_WATERTIGHT) const;

    // Returns the work of this thread's calls of trace() since it last asked.
    static TraversalSteps take_steps();

    // Returns the ray with which the trees are searched: `ray` itself, or from refined on one that may begin nearer,
    // `advance` in t.
    Ray searched_ray(const Ray& ray, uint level, double& advance) const;

    // The results of build(), for inspection.
    struct Tree {
        const Bvh& bvh;
        std::span<const BvhTriangle> triangles;  // of a geometry in layout bvh2, in units of `scale`
        float scale = 1;
    };
    Tree scene_tree() const { return {header_.bvh, {}}; }
    Tree geometry_tree(std::size_t instance) const;
    // Returns the nodes as node_boxes.h reads them, in every layout.
    SwGeometry scene_nodes() const;
    SwGeometry geometry_nodes(std::size_t instance) const {
        return geometries_[placed_[instance].first].block.geometry;
    }
    const SwInstance& instance(std::size_t index) const { return instances_[index]; }
    std::span<const LeafBox> instance_boxes() const { return instance_boxes_; }  // in world space

  private:
    TraceOptions trace_options(const Ray& ray, uint query, uint mask, uint level) const;

    // The target of InstanceRecord::geometry.
    struct Block {
        SwGeometry geometry{};
        GeometrySource source{};
    };
    static_assert(offsetof(Block, source) == GEOMETRY_SOURCE_OFFSET);
    struct BuiltGeometry {
        Geometry mesh;
        SharedArray<vec3> positions;  // in built units
        Hierarchy tree;
        std::vector<BvhTriangle> triangles;
        std::vector<CompressedRecord> records;
        Block block = {};

        uint leaf_count() const {
            return static_cast<uint>(mesh.leaves.empty() ? mesh.triangles.size() : mesh.leaves.size());
        }
    };
    uint root_of(const Hierarchy& tree) const;  // as it is laid out
    std::vector<InstanceRecord> records_in_built_units();
    void build_refinement(std::span<const InstanceRecord> records);

    Layout layout_;
    BuildQuality quality_;
    std::vector<BuiltGeometry> geometries_;
    std::vector<std::pair<std::size_t, InstanceRecord>> placed_;
    std::vector<SwInstance> instances_;
    std::vector<LeafBox> instance_boxes_;
    Hierarchy top_;
    std::vector<CompressedRecord> top_records_;
    SwTlasHeader header_{};
    GeometryBox bound_{};  // of the world
    std::vector<RefineInstance> refined_;
};

// Makes the same scene, in the order in which push_scene() places it.
std::unique_ptr<Scene> cpu_reference_of(const twinray::Scene& scene, const AccelOptions& trees = {});

}  // namespace twinray::reference
