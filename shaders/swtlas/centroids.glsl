// SPDX-License-Identifier: MIT Adds the centres of a block's leaves to their tree's CentroidBounds: each invocation
// those of its own leaves, then a tree in workgroup memory, then six atomics.
#ifndef TWINRAY_SWTLAS_CENTROIDS_GLSL
#define TWINRAY_SWTLAS_CENTROIDS_GLSL
#include "shaders/shared/build.h"
#include "shaders/shared/morton.h"
layout(local_size_x_id = GROUP_SIZE_CONSTANT) in;

shared vec3 group_lo[gl_WorkGroupSize.x];
shared vec3 group_hi[gl_WorkGroupSize.x];

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
    group_lo[thread] = centers.lo;
    group_hi[thread] = centers.hi;
    barrier();
    for (uint stride = gl_WorkGroupSize.x / 2u; stride > 0u; stride /= 2u)
    {
        if (thread < stride)
        {
            group_lo[thread] = min(group_lo[thread], group_lo[thread + stride]);
            group_hi[thread] = max(group_hi[thread], group_hi[thread + stride]);
        }
        barrier();
    }
    if (thread >= 3u || !(group_lo[0][thread] <= group_hi[0][thread])) return;
    atomicMin(AT(centroids, tree).lo[thread], ordered_bits(group_lo[0][thread]));
    atomicMax(AT(centroids, tree).hi[thread], ordered_bits(group_hi[0][thread]));
}
#endif
