// SPDX-License-Identifier: MIT
// Adds the centres of a chunk's leaves to their tree's CentroidBounds: each invocation those of its own leaves, then a
// tree in workgroup memory, then six atomics.
#ifndef TWINRAY_SWTLAS_CENTROIDS_GLSL
#define TWINRAY_SWTLAS_CENTROIDS_GLSL
#include "shaders/shared/build.h"
#include "shaders/shared/morton.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;

#include "shaders/engine/group_box.glsl"

void add_center(inout LeafBox centers, LeafBox box)
{
    if (!is_active(box)) return;
    vec3 center = center_of(box);
    centers.lo = min(centers.lo, center);
    centers.hi = max(centers.hi, center);
}

// Called by all invocations of the group.
void add_centroids(REF(CentroidBounds) centroids, uint tree, LeafBox centers)
{
    uint thread = gl_LocalInvocationID.x;
    join_boxes(centers.lo, centers.hi);
    if (thread >= 3u || !(group_lo[0][thread] <= group_hi[0][thread])) return;
    atomicMin(AT(centroids, tree).lo[thread], ordered_bits(group_lo[0][thread]));
    atomicMax(AT(centroids, tree).hi[thread], ordered_bits(group_hi[0][thread]));
}
#endif
