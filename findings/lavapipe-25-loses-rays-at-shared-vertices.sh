#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: a ray from inside a closed mesh hits it. Vulkan says that implementations should not miss where a ray
# meets a vertex that a closed fan of triangles of one winding shares.
# Seen: lavapipe of Mesa 25.0.7 loses some two of a hundred rays that are aimed at such vertices; that of 26.1.6 loses
# none. The mesh is a sphere of 16,128 triangles by index, all wound alike; origins lie within half its radius; each
# direction is the difference of vertex and origin in floats.
# Seen with 25.0.7-2+deb13u1 and 26.1.6-1~bpo13+1 of mesa-vulkan-drivers on 2026-11-27; by hand also with 26.2.6-1
# (sid), which does as 26.1.6 does.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_lavapipe_room

cat >"$probe/rays.comp" <<'END'
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_ray_query : require
layout(local_size_x = 64) in;
layout(buffer_reference, std430) buffer Rays { vec4 at[]; };
layout(buffer_reference, std430) buffer Hits { uint at[]; };
layout(push_constant) uniform Arguments { uvec2 scene; Rays rays; Hits hits; };
void main()
{
    const uint i = gl_GlobalInvocationID.x;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, accelerationStructureEXT(scene), gl_RayFlagsOpaqueEXT, 0xff, rays.at[2 * i].xyz, 0.0,
                          rays.at[2 * i + 1].xyz, 1e30);
    while (rayQueryProceedEXT(query)) {}
    hits.at[i] = rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT ? 1 : 0;
}
END
cat >"$probe/rays.c" <<'END'
#include "vk.h"
enum { RINGS = 63, AROUND = 128, VERTICES = RINGS * AROUND + 2, TRIANGLES = 2 * RINGS * AROUND, RAYS = 131072 };
int main(void) {
    open_device();
    const Buffer positions = new_buffer(12 * VERTICES), indices = new_buffer(12 * TRIANGLES);
    float(*position)[3] = positions.data;
    uint32_t* index = indices.data;
    const uint32_t south = VERTICES - 2, north = VERTICES - 1;
    position[south][2] = -1;
    position[north][2] = 1;
    for (uint32_t ring = 0; ring < RINGS; ++ring)
        for (uint32_t i = 0; i < AROUND; ++i) {
            const double latitude = M_PI * ((ring + 1.0) / (RINGS + 1) - 0.5), longitude = 2 * M_PI * i / AROUND;
            float* p = position[ring * AROUND + i];
            p[0] = (float)(cos(latitude) * cos(longitude));
            p[1] = (float)(cos(latitude) * sin(longitude));
            p[2] = (float)sin(latitude);
            const uint32_t a = ring * AROUND + i, b = ring * AROUND + (i + 1) % AROUND;
            const uint32_t c = ring + 1 < RINGS ? a + AROUND : north, d = ring + 1 < RINGS ? b + AROUND : north;
            const uint32_t below[3] = {b, a, south}, up[3] = {a, b, c}, across[3] = {b, d, c};
            if (ring == 0) memcpy(index, below, 12), index += 3;
            memcpy(index, up, 12), index += 3;
            if (ring + 1 < RINGS) memcpy(index, across, 12), index += 3;
        }
    const uint32_t count = (uint32_t)(index - (uint32_t*)indices.data) / 3;
    const VkAccelerationStructureGeometryKHR geometry = triangles(positions, VERTICES, indices);
    const Structure top = build_top(build_bottom(0, 1, &geometry, &count));

    const Buffer rays = new_buffer(32 * RAYS), hits = new_buffer(4 * RAYS);
    float(*ray)[8] = rays.data;
    for (uint32_t i = 0; i < RAYS; ++i) {
        float* origin = ray[i];
        do
            for (int k = 0; k < 3; ++k) origin[k] = random_unit() - 0.5f;
        while (origin[0] * origin[0] + origin[1] * origin[1] + origin[2] * origin[2] > 0.25f);
        const float* aim = position[(uint32_t)(random_unit() * VERTICES)];
        for (int k = 0; k < 3; ++k) ray[i][4 + k] = aim[k] - origin[k];
    }
    const VkDeviceAddress push[3] = {top.address, rays.address, hits.address};
    run_kernel("rays.spv", push, sizeof push, RAYS / 64);
    uint32_t lost = RAYS;
    for (uint32_t i = 0; i < RAYS; ++i) lost -= ((uint32_t*)hits.data)[i];
    printf("%u\n", lost);
    fprintf(stderr, "%u triangles, lost %u of %u rays\n", count, lost, RAYS);
    return 0;
}
END
kernel rays
program rays
before=$(on_driver "$mesa_25" ./rays)
after=$(on_driver "$mesa_26" ./rays)
holds "Mesa $mesa_25 loses more than 500 of 131,072 rays: $before" $((before > 500))
holds "Mesa $mesa_26 loses at most 20: $after" $((after <= 20))
conclude
