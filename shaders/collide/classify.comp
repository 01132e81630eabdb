// SPDX-License-Identifier: MIT
// Classifies each pair of triangles; pairs that are not separate are listed.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/collide/world_triangle.glsl"
#include "shaders/collide/neighbours.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ClassifyArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    PairContact contact;
    contact.first = AT(args.first, i);
    contact.second = AT(args.second, i);
    contact.class_of_pair = class_of_pair(AT(args.triangles, contact.first), AT(args.names, contact.first),
                                          AT(args.triangles, contact.second), AT(args.names, contact.second));
    contact.reserved = i;
    if (contact.class_of_pair == PAIR_SEPARATE) return;
    AT(args.contacts, atomicAdd(AT(args.total, 0).low, 1u)) = contact;
}
