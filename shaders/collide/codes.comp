// SPDX-License-Identifier: MIT
// Where the boxes' centres lie along a Hilbert curve: the lower 30 bits of the boxes in the order given, then the
// higher of those in the order that sorting by the former made.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/box_tree.h"
#include "shaders/collide/hilbert.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { HilbertOrderArgs args; };

void main()
{
    uint i = global_index();
    if (i >= args.count) return;
    uint index = i;
    if (args.is_coarse != 0u) index = AT(args.order, i);
    WorldBoundBits bits = AT(args.bits, 0);
    vec3 low = vec3(from_ordered_bits(bits.lo.x), from_ordered_bits(bits.lo.y), from_ordered_bits(bits.lo.z));
    vec3 high = vec3(from_ordered_bits(bits.hi.x), from_ordered_bits(bits.hi.y), from_ordered_bits(bits.hi.z));
    TreeBox box = AT(args.boxes, index);
    vec3 size = high - low;
    uint code = 0u;
    float side = max(size.x, max(size.y, size.z));
    if (!is_empty(box)) code = hilbert_code(center_of(box), low, side, args.is_coarse != 0u);
    AT(args.keys, i) = code;
}
