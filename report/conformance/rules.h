// SPDX-License-Identifier: MIT
// Vulkan's rules of what a ray may meet at all: flags of geometries, instances and rays, and masks.
#pragma once

#include <vulkan/vulkan_core.h>

#include "report/conformance/query.h"

namespace twinray::conformance {

// Flags of a ray, with SPIR-V's values.
enum RayFlag : uint {
    ray_opaque = 0x1,
    ray_no_opaque = 0x2,
    ray_terminates = 0x4,         // on the first hit
    ray_skips_closest_hit = 0x8,  // shaders, of which a query has none
    ray_culls_back = 0x10,
    ray_culls_front = 0x20,
    ray_culls_opaque = 0x40,
    ray_culls_no_opaque = 0x80,
    ray_skips_triangles = 0x100,
    ray_skips_boxes = 0x200,
};

// The flags that meet where a ray meets a primitive.
struct MetFlags {
    VkGeometryFlagsKHR geometry = 0;
    VkGeometryInstanceFlagsKHR instance = 0;
    uint ray = 0;
};

// The ray's word counts before the instance's, and that before the geometry's.
bool is_opaque(const MetFlags& flags);
// The side that (v1 - v0) x (v2 - v0) points to is the front, unless the instance turns it.
bool is_front(const MetFlags& flags, bool sees_normal_side);
bool is_culled_triangle(const MetFlags& flags, bool sees_normal_side);
bool is_culled_box(const MetFlags& flags);

}  // namespace twinray::conformance
