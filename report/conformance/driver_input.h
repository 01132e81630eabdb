// SPDX-License-Identifier: MIT
// A build's input in device memory, and in the form that Vulkan expects.
#pragma once

#include <vector>

#include "engine/core/commands.h"
#include "report/conformance/scene_input.h"

namespace twinray::conformance {

// Returns the bytes of a geometry's vertices in its format, including the padding, the vertices before the first, and
// as many after.
std::vector<std::byte> encoded_vertices(const GeometryInput& geometry);
std::vector<std::byte> encoded_indices(const GeometryInput& geometry);
std::vector<std::byte> encoded_boxes(const GeometryInput& geometry);
std::uint32_t vertex_stride(const GeometryInput& geometry);

// The arguments of vkCmdBuildAccelerationStructuresKHR for one structure.
struct BuildInput {
    std::vector<VkAccelerationStructureGeometryKHR> geometries;
    std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
    std::vector<std::uint32_t> counts;  // of primitives
    VkBuildAccelerationStructureFlagsKHR flags = 0;
    VkAccelerationStructureTypeKHR type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
};

// A bottom level as instances refer to it.
struct BottomRef {
    std::uint64_t address = 0;
    bool holds_boxes = false;
};

// Uploads in its own passes; the buffers live as long as the commands need them.
BuildInput upload(Commands& commands, const BottomInput& input);
BuildInput upload(Commands& commands, const TopInput& input, const std::vector<BottomRef>& bottoms);

}  // namespace twinray::conformance
