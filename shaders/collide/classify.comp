// SPDX-License-Identifier: MIT
// Classifies each pair of triangles; pairs that are not separate are listed.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/world_triangle.glsl"
#include "shaders/collide/orient.h"
int volume_sign(dvec3 a, dvec3 b, dvec3 c, dvec3 d) { return filtered_volume_sign(a, b, c, d); }
int area_sign(dvec3 a, dvec3 b, dvec3 c, uint axis) { return filtered_area_sign(a, b, c, axis); }
#include "shaders/collide/neighbours.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ClassifyArgs args; };

void main()
{
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
