// Meshes and boxes as accelerators keep them, and the records of instances.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <twinray/device_mesh.h>
#include <twinray/trace.h>

#include "twinray/glsl/cpp.h"

namespace twinray {

#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/instance.h"
#include "shaders/shared/leaf.h"
#include "twinray/glsl/cpp_end.h"

// A mesh with other vertices and the same triangles.
struct Welded {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;

    bool is_empty() const { return triangles.empty(); }
};

// Returns the positions times a power of two; those themselves for 1.
SharedArray<vec3> times(const SharedArray<vec3>& positions, float factor);

// A mesh or boxes as an accelerator keeps them on the host.
struct Geometry {
    std::string name;
    uint kind = GEOMETRY_TRIANGLES;
    float scale = 1;              // the unit of what is built of it: a power of two
    SharedArray<vec3> positions;  // as given; these three of GEOMETRY_TRIANGLES
    SharedArray<uvec3> triangles;
    std::size_t non_finite_triangles = 0;  // inactive: never hit, still counted
    std::vector<Bounds> boxes;             // of GEOMETRY_BOXES
    // The leaves for the accelerator's builder; empty: each primitive is one. A build needs it.
    std::vector<Leaf> leaves;
    Welded welded;  // until a build: the mesh that it uses, unless this is empty
    // Replaces `triangles`, and `positions` until the host gives some: the caller's data in device memory, without its
    // name and attributes.
    std::optional<DeviceMesh> device;
    // The former counts of both, once forget_mesh() was called.
    struct Counts {
        std::size_t vertices, triangles;
    };
    std::optional<Counts> forgotten;

    // Throws Error naming the mesh and the limit: an index out of range, more than max_primitives.
    explicit Geometry(const MeshView& mesh) : Geometry(mesh, near_unit(mesh.positions)) {}
    Geometry(const MeshView& mesh, float unit);
    // Throws Error as check_device_mesh() does.
    Geometry(const DeviceMesh& mesh, float unit);
    // Throws Error naming the box: one that is empty or not finite, or more than max_primitives.
    explicit Geometry(const BoxesView& boxes);

    // Frees the host's copy of a built mesh; also `leaves`, unless the device has a copy to build from again.
    void forget_mesh(bool is_on_device);
    std::uint64_t host_bytes() const;
    // Returns the positions in units of `scale`.
    SharedArray<vec3> built_positions() const { return times(positions, 1 / scale); }
    // Returns the exponent of the largest finite coordinate, which is below 2^(1 + exponent); 0 if all are 0.
    static int size_exponent(std::span<const vec3> positions);
    // Returns the power of two just below the largest finite coordinate, so that coordinates in this unit are near 1.
    static float near_unit(std::span<const vec3> positions);

    std::size_t vertex_count() const { return counts().vertices; }
    std::size_t triangle_count() const { return counts().triangles; }
    Counts counts() const {
        if (device) return {device->vertex_count, device->triangle_count};
        return forgotten.value_or(Counts{positions.size(), triangles.size()});
    }
    std::size_t primitive_count() const { return kind == GEOMETRY_BOXES ? boxes.size() : triangle_count(); }
    // Returns whether the memory of the other's structures has room for this one's.
    bool fits_in_place_of(const Geometry& other) const {
        return device && other.device && vertex_count() == other.vertex_count() &&
               triangle_count() == other.triangle_count() && scale == other.scale &&
               is_in_place() == other.is_in_place();
    }
    bool is_in_place() const { return device && device->in_place; }

    // Leaf positions have 25 bits in the bound on the tree's depth, and records of a tree 26 (see compressed.h).
    static constexpr std::size_t max_primitives = (1u << 25) - 1;
};

// Makes the record of one instance, geometry address left 0, for a transform without fault_of() and a custom index up
// to max_custom_index.
InstanceRecord make_instance_record(const Transform& transform, const InstanceOptions& options = {});
InstanceOptions options_of(const InstanceRecord& record);
Transform transform_of(const InstanceRecord& record);

}  // namespace twinray
