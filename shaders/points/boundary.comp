// SPDX-License-Identifier: MIT
// Sums the angles under which points see the area that the edges of open surfaces sweep.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/world_triangle.glsl"
#include "shaders/collide/orient.h"
int volume_sign(dvec3 a, dvec3 b, dvec3 c, dvec3 d) { return filtered_volume_sign(a, b, c, d); }
int area_sign(dvec3 a, dvec3 b, dvec3 c, uint axis) { return filtered_area_sign(a, b, c, axis); }
#include "shaders/points/point_boundary.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { BoundaryArgs args; };

void main()
{
    uint i = args.first + global_index();
    if (i >= args.end) return;
    dvec3 point = AT(args.points, i).at;
    AngleSum sum = no_angle();
    for (uint edge = 0u; edge < args.edge_count; ++edge) sum = with_edge(sum, point, AT(args.edges, edge));
    AT(args.angles, i) = sum;
}
