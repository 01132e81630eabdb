// SPDX-License-Identifier: MIT
// The order of boxes by their centres: a box around those that are not empty, and their places along a Hilbert curve
// through the 2^20 x 2^20 x 2^20 cells of a cube, 60 bits: the lower 30 of the boxes in the order given, then the
// higher of those in the order that sorting by the former made. Unlike a Morton curve it never jumps, so that each
// stretch of it is in a small box (Kamel and Faloutsos, "Hilbert R-tree", 1994).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/box_tree.h"
layout(push_constant, scalar) uniform Push { HilbertOrderArgs args; };

#ifdef KERNEL_CENTERS
layout(local_size_x = WORLD_BOUND_GROUP) in;
#include "shaders/engine/group_box.glsl"

void main() {
    if (group_index() >= args.group_count) return;
    GeometryBox box = no_box();
    uint stride = args.group_count * WORLD_BOUND_GROUP;
    for (uint i = global_index(); i < args.count; i += stride) {
        TreeBox given = AT(args.boxes, i);
        vec3 center = center_of(given);
        if (is_empty(given) || !is_finite(center)) continue;
        box.lo = min(box.lo, center);
        box.hi = max(box.hi, center);
    }
    add_box(args.bits, args.group_count, box);
}
#endif

#ifdef KERNEL_CODES
layout(local_size_x = 64) in;

const uint HILBERT_BITS = 20u;  // an axis

// Deals the bits of the index out to three words, from the highest on: Skilling, "Programming the Hilbert curve", 2004.
uvec3 hilbert_words(uvec3 cell) {
    uvec3 x = cell;
    for (uint bit = 1u << (HILBERT_BITS - 1u); bit > 1u; bit = bit >> 1u) {
        uint below = bit - 1u;
        if ((x.x & bit) != 0u) x.x = x.x ^ below;
        uint swapped = (x.y & bit) != 0u ? 0u : (x.x ^ x.y) & below;
        x.x = x.x ^ ((x.y & bit) != 0u ? below : swapped);
        x.y = x.y ^ swapped;
        swapped = (x.z & bit) != 0u ? 0u : (x.x ^ x.z) & below;
        x.x = x.x ^ ((x.z & bit) != 0u ? below : swapped);
        x.z = x.z ^ swapped;
    }
    x.y = x.y ^ x.x;
    x.z = x.z ^ x.y;
    uint flips = 0u;
    for (uint bit = 1u << (HILBERT_BITS - 1u); bit > 1u; bit = bit >> 1u)
        if ((x.z & bit) != 0u) flips = flips ^ (bit - 1u);
    return uvec3(x.x ^ flips, x.y ^ flips, x.z ^ flips);
}

// Returns the 30 higher or lower bits of the index of the cell with a point of the cube from `low` with sides `size`.
uint hilbert_code(vec3 point, vec3 low, float size, bool is_higher) {
    uvec3 words = hilbert_words(cells_of(point, low, low + vec3(size)));
    uint shift = is_higher ? 10u : 0u;
    return interleaved((words.x >> shift) & 1023u, (words.y >> shift) & 1023u, (words.z >> shift) & 1023u);
}

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    uint index = i;
    if (args.is_coarse != 0u) index = AT(args.order, i);
    GeometryBox cube = box_of(AT(args.bits, 0));
    TreeBox box = AT(args.boxes, index);
    vec3 size = cube.hi - cube.lo;
    uint code = 0u;
    float side = max(size.x, max(size.y, size.z));
    if (!is_empty(box)) code = hilbert_code(center_of(box), cube.lo, side, args.is_coarse != 0u);
    AT(args.keys, i) = code;
}
#endif
