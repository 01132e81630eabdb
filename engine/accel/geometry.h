// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "engine/accel/instance_record.h"
#include "engine/core/transform.h"
#include "engine/scene/mesh.h"

namespace twinray {

// A mesh as an accelerator keeps it: its own copy of what tracing needs.
struct Geometry {
    std::string name;
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;
    std::size_t non_finite_triangles = 0;  // inactive: never hit, still counted

    // Throws Error naming the mesh and the limit: an index out of range, more than max_triangles.
    explicit Geometry(const MeshView& mesh);

    // Leaf positions have 24 bits in the bound on the tree's depth.
    static constexpr std::size_t max_triangles = (1u << 24) - 1;
};

constexpr std::size_t max_instances = (1u << 24) - 1;  // of an accelerator; what Vulkan guarantees at least
constexpr uint max_custom_index = (1u << 24) - 1;

// The record of one instance, geometry address left 0, for a transform without fault_of() and a custom index up to
// max_custom_index.
InstanceRecord make_instance_record(const Transform& transform, uint custom_index, std::uint8_t mask);
Transform transform_of(const InstanceRecord& record);

}  // namespace twinray
