// SPDX-License-Identifier: MIT
// Makes a box around each point.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/world_triangle.glsl"
#include "shaders/points/point_search.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PointSearchArgs args; };

void main()
{
    uint i = global_index();
    if (i < args.end) AT(args.boxes, i) = tree_box_of(AT(args.points, i).at, i);
}
