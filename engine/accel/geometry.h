// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "engine/accel/instance_record.h"
#include "engine/core/transform.h"
#include "engine/scene/mesh.h"

namespace twinray {

// Boxes in object space that stand for primitives of the user's, not owned. A trace program says how rays meet them.
struct BoxesView {
    std::string_view name;
    std::span<const Bounds> boxes;
};

// A mesh or boxes as an accelerator keeps them: its own copy of what tracing needs.
struct Geometry {
    std::string name;
    uint kind = GEOMETRY_TRIANGLES;
    float scale = 1;              // what `positions` are in units of: a power of two
    std::vector<vec3> positions;  // these three of GEOMETRY_TRIANGLES
    std::vector<uvec3> triangles;
    std::size_t non_finite_triangles = 0;  // inactive: never hit, still counted
    std::vector<Bounds> boxes;             // of GEOMETRY_BOXES

    // Throws Error naming the mesh and the limit: an index out of range, more than max_primitives.
    explicit Geometry(const MeshView& mesh) : Geometry(mesh, near_unit(mesh.positions)) {}
    Geometry(const MeshView& mesh, float unit);
    // Throws Error naming the box: one that is empty or not finite, or more than max_primitives.
    explicit Geometry(const BoxesView& boxes);

    // Other positions, as many, in the user's units.
    void move_to(std::span<const vec3> others);
    // As the user gave them.
    std::vector<vec3> given_positions() const;
    // The power of two just below the largest finite coordinate, so that coordinates in units of it are near 1.
    static float near_unit(std::span<const vec3> positions);

    std::size_t primitive_count() const { return kind == GEOMETRY_BOXES ? boxes.size() : triangles.size(); }

    // Leaf positions have 25 bits in the bound on the tree's depth, and records of a tree 26 (see compressed.h).
    static constexpr std::size_t max_primitives = (1u << 25) - 1;
};

constexpr std::size_t max_instances = (1u << 24) - 1;  // of an accelerator; what Vulkan guarantees at least
constexpr uint max_custom_index = (1u << 24) - 1;

struct InstanceOptions {
    uint custom_index = 0;     // returned in Hit::custom_index; at most 2^24 - 1
    std::uint8_t mask = 0xff;  // an instance is seen by rays whose mask shares a bit
    bool no_culling = false;   // both sides are hit by rays that cull, too
    bool turned = false;       // front and back exchanged
    bool filtered = false;     // not opaque: a trace program decides about each hit

    bool operator==(const InstanceOptions&) const = default;
};

// The record of one instance, geometry address left 0, for a transform without fault_of() and a custom index up to
// max_custom_index.
InstanceRecord make_instance_record(const Transform& transform, const InstanceOptions& options = {});
InstanceOptions options_of(const InstanceRecord& record);
Transform transform_of(const InstanceRecord& record);

}  // namespace twinray
