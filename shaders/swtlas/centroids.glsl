// SPDX-License-Identifier: MIT
// Adds the centres of a group's leaves to their tree's CentroidBounds: a tree in workgroup memory, then six atomics.
#ifndef TWINRAY_SWTLAS_CENTROIDS_GLSL
#define TWINRAY_SWTLAS_CENTROIDS_GLSL
#include "shaders/shared/build.h"
#include "shaders/shared/morton.h"

shared vec3 group_lo[BUILD_GROUP];
shared vec3 group_hi[BUILD_GROUP];

// Called by all invocations of the group; those without a leaf pass an empty box.
void add_centroids(REF(CentroidBounds) centroids, uint tree, LeafBox box)
{
    uint thread = gl_LocalInvocationIndex;
    LeafBox none = empty_box();
    vec3 center = center_of(box);
    group_lo[thread] = is_active(box) ? center : none.lo;
    group_hi[thread] = is_active(box) ? center : none.hi;
    barrier();
    for (uint stride = BUILD_GROUP / 2u; stride > 0u; stride /= 2u)
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
