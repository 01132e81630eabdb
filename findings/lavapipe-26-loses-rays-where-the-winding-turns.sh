#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: with opaque triangles and no culling, the order of a triangle's corners does not matter. So turning
# the lower half of a closed mesh inside out changes no hit of a ray from inside.
# Seen: lavapipe of Mesa 26.1.6 loses no ray aimed at a vertex where all triangles are wound alike, and a third of the
# rays aimed at the vertices between two halves that are wound differently. 25.0.7 loses as few with the one mesh as
# with the other. Vulkan speaks of shared edges for triangles of the same winding alone, so a mesh for rays has to be
# wound alike although nothing culls.
# Seen with 25.0.7-2+deb13u1 and 26.1.6-1~bpo13+1 of mesa-vulkan-drivers on 2026-11-27; by hand also with 26.2.6-1
# (sid), which does as 26.1.6 does.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_lavapipe_room

cat >"$probe/winding.comp" <<'END'
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_ray_query : require
layout(local_size_x = 64) in;
layout(buffer_reference, std430) buffer Vectors { vec4 at[]; };
layout(buffer_reference, std430) buffer Count { uint missed; };
layout(push_constant) uniform Arguments { uvec2 scene; Vectors rays; Count count; };
void main()
{
    const uint i = gl_GlobalInvocationID.x;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, accelerationStructureEXT(scene), gl_RayFlagsOpaqueEXT, 0xff, rays.at[2 * i].xyz, 0.0,
                          rays.at[2 * i + 1].xyz, 1e30);
    while (rayQueryProceedEXT(query)) {}
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT)
        atomicAdd(count.missed, 1);
}
END
cat >"$probe/winding.c" <<'END'
#include "vk.h"
enum { AROUND = 64, VERTICES = AROUND + 2, TRIANGLES = 2 * AROUND, RAYS = 65536 };
int main(void) { // prints rays lost with all triangles wound alike, then with the lower half turned
    open_device();
    const Buffer positions = new_buffer(12 * VERTICES), indices = new_buffer(12 * TRIANGLES);
    const Buffer rays = new_buffer(32 * RAYS);
    float(*position)[3] = positions.data;
    for (uint32_t i = 0; i < AROUND; ++i) { // two cones on one uneven rim
        position[i][0] = (float)cos(2 * M_PI * i / AROUND);
        position[i][1] = (float)sin(2 * M_PI * i / AROUND);
        position[i][2] = 0.2f * random_unit();
    }
    position[AROUND][2] = 1;
    position[AROUND + 1][2] = -1;
    for (uint32_t i = 0; i < RAYS; ++i) {
        float* ray = (float*)rays.data + 8 * i;
        const float* aim = position[i % AROUND];
        for (int k = 0; k < 3; ++k) {
            ray[k] = 0.4f * (random_unit() - 0.5f);
            ray[4 + k] = aim[k] - ray[k];
        }
    }
    for (uint32_t turned = 0; turned < 2; ++turned) {
        uint32_t(*index)[3] = indices.data;
        for (uint32_t i = 0; i < AROUND; ++i) {
            const uint32_t next = (i + 1) % AROUND;
            const uint32_t upper[3] = {i, next, AROUND};
            const uint32_t lower[3] = {turned ? i : next, turned ? next : i, AROUND + 1};
            memcpy(index[2 * i], upper, 12);
            memcpy(index[2 * i + 1], lower, 12);
        }
        const VkAccelerationStructureGeometryKHR geometry = triangles(positions, VERTICES, indices);
        const uint32_t count = TRIANGLES;
        const Structure top = build_top(build_bottom(0, 1, &geometry, &count));
        const Buffer missed = new_buffer(4);
        const VkDeviceAddress push[3] = {top.address, rays.address, missed.address};
        run_kernel("winding.spv", push, sizeof push, RAYS / 64);
        printf("%u ", *(uint32_t*)missed.data);
    }
    printf("\n");
    return 0;
}
END
kernel winding
program winding
read -r alike_25 turned_25 < <(on_driver "$mesa_25" ./winding)
read -r alike_26 turned_26 < <(on_driver "$mesa_26" ./winding)
echo "of 65,536 rays are lost with all triangles wound alike, and with the lower half turned:"
echo "Mesa $mesa_25: $alike_25 and $turned_25, Mesa $mesa_26: $alike_26 and $turned_26"
holds "Mesa $mesa_25 loses at most 1,000 of either" $((alike_25 <= 1000 && turned_25 <= 1000))
holds "Mesa $mesa_26 loses at most 20 with all wound alike" $((alike_26 <= 20))
holds "Mesa $mesa_26 loses more than 6,000 with the lower half turned" $((turned_26 > 6000))
conclude
