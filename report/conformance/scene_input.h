// SPDX-License-Identifier: MIT
// The input of a driver's structures, as data on the host. The same data makes the expectation.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <vulkan/vulkan_core.h>

#include <twinray/geometry.h>

namespace twinray::conformance {

constexpr VkBuildAccelerationStructureFlagsKHR can_update = VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;

enum class Indices : std::uint8_t { none, bits16, bits32 };

// Triangles, or boxes if there are any.
struct GeometryInput {
    std::vector<vec3> positions = {};
    std::vector<uvec3> triangles = {};  // with Indices::none these are (0, 1, 2), (3, 4, 5), ...
    std::vector<Bounds> boxes = {};
    VkGeometryFlagsKHR flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
    Indices indices = Indices::bits32;
    VkFormat format = VK_FORMAT_R32G32B32_SFLOAT;  // of positions, which it can hold
    std::uint32_t padding = 0;                     // bytes between one vertex or box and the next
    std::optional<Transform> transform = {};
    // Data in the buffers before the input, which the build must skip.
    std::uint32_t first_vertex = 0;    // vertices
    std::uint32_t earlier_items = 0;   // triangles of the index buffer, or boxes
    std::uint32_t earlier_places = 0;  // transforms

    bool is_boxes() const { return !boxes.empty(); }
    std::uint32_t primitive_count() const {
        return static_cast<std::uint32_t>(is_boxes() ? boxes.size() : triangles.size());
    }
};

struct BottomInput {
    std::vector<GeometryInput> geometries;
    VkBuildAccelerationStructureFlagsKHR flags = 0;
};

inline constexpr std::uint32_t no_bottom = UINT32_MAX;  // of an inactive instance

struct InstanceInput {
    std::uint32_t bottom = 0;  // index into SceneInput::bottoms, or no_bottom
    Transform to_world = {};
    std::uint32_t custom_index = 0;
    std::uint32_t mask = 0xff;
    std::uint32_t sbt_offset = 0;
    VkGeometryInstanceFlagsKHR flags = 0;
};

struct TopInput {
    std::vector<InstanceInput> instances;
    VkBuildAccelerationStructureFlagsKHR flags = 0;
    bool has_pointers = false;  // the build gets addresses of instances in place of instances
};

struct SceneInput {
    std::vector<BottomInput> bottoms;
    TopInput top;
};

}  // namespace twinray::conformance
