// SPDX-License-Identifier: MIT
// Builds: formats of indices and vertices, and bytes between them.
#include <algorithm>
#include <cmath>

#include "report/conformance/case_run.h"
#include "report/conformance/suite.h"

namespace twinray::conformance {
namespace {

// Makes triangles that share vertices, in no order.
GeometryInput shared_vertices(Draws& draws, uint count) {
    GeometryInput geometry = random_triangles(draws, count);
    const uint vertices = static_cast<uint>(geometry.positions.size());
    for (uint i = 0; i < count; ++i) {
        uvec3 corners(draws.below(vertices), draws.below(vertices), draws.below(vertices));
        const vec3 a = geometry.positions[corners.x], b = geometry.positions[corners.y],
                   c = geometry.positions[corners.z];
        if (length(cross(dvec3(b - a), dvec3(c - a))) > 0.1) geometry.triangles.push_back(corners);
    }
    return geometry;
}

void index_formats(CaseRun& run) {
    for (const Indices indices : {Indices::bits16, Indices::bits32, Indices::none}) {
        GeometryInput geometry = indices == Indices::none ? random_triangles(run.draws(), usual_triangle_count)
                                                          : shared_vertices(run.draws(), usual_triangle_count);
        geometry.indices = indices;
        run.check_hits(scene_of(geometry), random_shots(run.draws(), run.rays() / 3 + 1));
    }
}

bool is_flat(VkFormat format) {
    return format == VK_FORMAT_R32G32_SFLOAT || format == VK_FORMAT_R16G16_SFLOAT || format == VK_FORMAT_R16G16_SNORM;
}
bool is_normalized(VkFormat format) {
    return format == VK_FORMAT_R16G16_SNORM || format == VK_FORMAT_R16G16B16A16_SNORM;
}

// Returns the nearest position that the format can hold.
vec3 held(VkFormat format, vec3 p) {
    if (is_flat(format)) p.z = 0;
    if (!is_normalized(format)) return p;
    const auto snorm = [](float value) { return std::round(std::clamp(value, -1.0f, 1.0f) * 32767) / 32767; };
    return {snorm(p.x), snorm(p.y), snorm(p.z)};
}

void vertex_formats(CaseRun& run) {
    for (const VkFormat format :
         {VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32_SFLOAT, VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT,
          VK_FORMAT_R16G16_SNORM, VK_FORMAT_R16G16B16A16_SNORM}) {
        GeometryInput geometry = random_triangles(run.draws(), usual_triangle_count);
        geometry.format = format;
        for (vec3& position : geometry.positions) position = held(format, position);
        run.check_hits(scene_of(geometry), random_shots(run.draws(), run.rays() / 6 + 1));
    }
}

void vertex_strides(CaseRun& run) {
    for (const std::uint32_t padding : {4u, 8u, 20u}) {
        GeometryInput geometry = random_triangles(run.draws(), usual_triangle_count);
        geometry.padding = padding;
        geometry.format = padding == 8 ? VK_FORMAT_R16G16B16A16_SFLOAT : VK_FORMAT_R32G32B32_SFLOAT;
        geometry.indices = padding == 20 ? Indices::none : Indices::bits32;
        run.check_hits(scene_of(geometry), random_shots(run.draws(), run.rays() / 3 + 1));
    }
}

void box_strides(CaseRun& run) {
    GeometryInput geometry = layered_boxes(5);
    geometry.padding = 8 * (1 + run.draws().below(3));
    run.check_candidates(scene_of(geometry), layer_shots(run.draws(), run.rays()));
}

}  // namespace

std::vector<Case> format_cases() {
    constexpr Topic topic = Topic::builds;
    constexpr Misdeed control = Misdeed::forgets_later_half;
    const std::string same = "hits are those of float64";
    return {
        {"K14", topic, "indices of 16 and 32 bits, and none", "VK-GL-CTS index formats", same, control, index_formats},
        {"K15", topic, "the six vertex formats that every driver has", "VK-GL-CTS vertex formats", same, control,
         vertex_formats},
        {"K16", topic, "vertices with bytes between them", "VK-GL-CTS vertex strides", same, control, vertex_strides},
        {"K17", topic, "boxes with bytes between them", "VK-GL-CTS box strides",
         "the boxes that a ray meets are offered", control, box_strides},
    };
}

}  // namespace twinray::conformance
