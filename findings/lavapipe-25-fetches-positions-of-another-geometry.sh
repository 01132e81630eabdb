#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: VK_KHR_ray_tracing_position_fetch gives the three positions of the triangle that was hit.
# Seen: where a bottom level has two geometries, lavapipe of Mesa 25.0.7 gives for a hit of the second one the
# positions of the triangle of the same number in the first. The hit itself says geometry and primitive rightly.
# 26.1.6 gives the right positions.
# Seen with 25.0.7-2+deb13u1 and 26.1.6-1~bpo13+1 of mesa-vulkan-drivers on 2026-11-27; by hand also with 26.2.6-1
# (sid), which does as 26.1.6 does.
folder=$(mktemp -d)
mesa_25=25.0.7-2+deb13u1
mesa_26=26.1.6-1~bpo13+1
# shellcheck source=findings/room.sh
. "$(dirname "${BASH_SOURCE[0]}")/room.sh"
make_lavapipe_room

cat >"$probe/fetch.comp" <<'END'
#version 460
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_ray_query : require
#extension GL_EXT_ray_tracing_position_fetch : require
layout(local_size_x = 1) in;
layout(buffer_reference, std430) buffer Vectors { vec4 at[]; };
layout(push_constant) uniform Arguments { uvec2 scene; Vectors origins, hits; };
void main()
{
    const uint i = gl_GlobalInvocationID.x;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, accelerationStructureEXT(scene), gl_RayFlagsOpaqueEXT, 0xff, origins.at[i].xyz, 0.0,
                          vec3(0, 0, 1), 1e30);
    while (rayQueryProceedEXT(query)) {}
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT) return;
    vec3 corners[3];
    rayQueryGetIntersectionTriangleVertexPositionsEXT(query, true, corners);
    hits.at[4 * i] = vec4(rayQueryGetIntersectionGeometryIndexEXT(query, true),
                          rayQueryGetIntersectionPrimitiveIndexEXT(query, true), 0, 1);
    for (int k = 0; k < 3; ++k) hits.at[4 * i + 1 + k] = vec4(corners[k], 0);
}
END
cat >"$probe/fetch.c" <<'END'
#include "vk.h"
int main(void) {
    open_device();
    // Four triangles side by side, two in each geometry; triangle i of all has its corners near x = 10 i.
    float corners[4][3][3];
    const Buffer origins = new_buffer(4 * 16), hits = new_buffer(4 * 64);
    VkAccelerationStructureGeometryKHR geometries[2];
    const uint32_t counts[2] = {2, 2}, order[6] = {0, 1, 2, 3, 4, 5};
    for (int i = 0; i < 4; ++i) {
        const float x = 10.0f * i, z = 1.0f + i, given[3][3] = {{x, 0, z}, {x + 3, 0, z}, {x, 3, z}};
        const float origin[4] = {x + 1, 1, 0, 0};
        memcpy(corners[i], given, sizeof given);
        memcpy((char*)origins.data + 16 * i, origin, 16);
    }
    for (int g = 0; g < 2; ++g) {
        const Buffer positions = new_buffer(72), indices = new_buffer(24);
        memcpy(positions.data, corners[2 * g], 72);
        memcpy(indices.data, order, 24);
        geometries[g] = triangles(positions, 6, indices);
    }
    const Structure top =
        build_top(build_bottom(VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_DATA_ACCESS_KHR, 2, geometries, counts));
    const VkDeviceAddress push[3] = {top.address, origins.address, hits.address};
    run_kernel("fetch.spv", push, sizeof push, 4);
    const float(*hit)[4][4] = hits.data;
    for (int i = 0; i < 4; ++i) {
        int found = -1;
        for (int j = 0; j < 4; ++j)
            if (memcmp(hit[i][1], corners[j][0], 12) == 0 && memcmp(hit[i][2], corners[j][1], 12) == 0 &&
                memcmp(hit[i][3], corners[j][2], 12) == 0)
                found = j;
        printf("%s%.0f.%.0f ", i > 0 ? ", " : "", hit[i][0][0], hit[i][0][1]);
        if (hit[i][0][3] != 1) printf("no hit");
        else if (found < 0) printf("has positions of none");
        else printf("has those of %d.%d", found / 2, found % 2);
    }
    printf("\n");
    return 0;
}
END
kernel fetch
program fetch
echo "geometry.primitive of four hits, and whose positions were fetched:"
same "Mesa $mesa_25" "$(on_driver "$mesa_25" ./fetch)" \
    "0.0 has those of 0.0, 0.1 has those of 0.1, 1.0 has those of 0.0, 1.1 has those of 0.1"
same "Mesa $mesa_26" "$(on_driver "$mesa_26" ./fetch)" \
    "0.0 has those of 0.0, 0.1 has those of 0.1, 1.0 has those of 1.0, 1.1 has those of 1.1"
conclude
