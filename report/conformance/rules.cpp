// SPDX-License-Identifier: MIT
#include "report/conformance/rules.h"

namespace twinray::conformance {
namespace {

bool is_culled_by_opacity(const MetFlags& flags) {
    return (flags.ray & (is_opaque(flags) ? ray_culls_opaque : ray_culls_no_opaque)) != 0;
}

}  // namespace

bool is_opaque(const MetFlags& flags) {
    if (flags.ray & (ray_opaque | ray_no_opaque)) return (flags.ray & ray_opaque) != 0;
    constexpr VkGeometryInstanceFlagsKHR forced = VK_GEOMETRY_INSTANCE_FORCE_OPAQUE_BIT_KHR;
    if (flags.instance & (forced | VK_GEOMETRY_INSTANCE_FORCE_NO_OPAQUE_BIT_KHR)) return (flags.instance & forced) != 0;
    return (flags.geometry & VK_GEOMETRY_OPAQUE_BIT_KHR) != 0;
}

bool is_front(const MetFlags& flags, bool sees_normal_side) {
    const bool is_turned = (flags.instance & VK_GEOMETRY_INSTANCE_TRIANGLE_FLIP_FACING_BIT_KHR) != 0;
    return sees_normal_side != is_turned;
}

bool is_culled_triangle(const MetFlags& flags, bool sees_normal_side) {
    if ((flags.ray & ray_skips_triangles) || is_culled_by_opacity(flags)) return true;
    if (flags.instance & VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR) return false;
    return (flags.ray & (is_front(flags, sees_normal_side) ? ray_culls_front : ray_culls_back)) != 0;
}

bool is_culled_box(const MetFlags& flags) { return (flags.ray & ray_skips_boxes) || is_culled_by_opacity(flags); }

}  // namespace twinray::conformance
