// SPDX-License-Identifier: MIT
// The order in which rays that come at random are traced: by their origins, then by their directions.
#ifndef TWINRAY_SHARED_RAY_ORDER_H
#define TWINRAY_SHARED_RAY_ORDER_H
#include "shaders/shared/world_bound.h"

const uint RAY_CELL_BITS = 3u;  // of each axis of the grid
const uint RAY_KEY_BITS = 3u * RAY_CELL_BITS + 3u;
const uint LAST_RAY_KEY = (1u << RAY_KEY_BITS) - 1u;

const uint RAYS_IN_BOX = 16u;  // of an invocation: processors pay dearly for the barriers of a group

struct RayOrderArgs {
    REF(Ray) rays;
    Uints indirect_count;     // see TraceArgs
    REF(WorldBoundBits) box;  // around the origins
    Uints keys;
    uint count;
    uint group_count;  // of the kernel that finds the box
};

// Returns the octant by the negative components: x in the highest bit.
FUNC uint octant_of(vec3 direction) {
    return (direction.x < 0.0f ? 4u : 0u) | (direction.y < 0.0f ? 2u : 0u) | (direction.z < 0.0f ? 1u : 0u);
}

// Rays sorted by it follow the Morton curve through a grid of the box, and within a cell the octants. Rays that are not
// traced come last.
FUNC uint ray_key(Ray ray, GeometryBox box) {
    if (!is_traceable(ray)) return LAST_RAY_KEY;
    uint cell = morton_code(ray.origin, box.lo, box.hi) >> (30u - 3u * RAY_CELL_BITS);
    return cell << 3u | octant_of(ray.direction);
}
#endif
