// SPDX-License-Identifier: MIT
// Sums the angles under which points see the area that the edges of open surfaces sweep.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/collide/world_triangle.glsl"
#include "shaders/points/point_boundary.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { BoundaryArgs args; };

void main() {
    uint i = args.first + global_index();
    if (i >= args.end) return;
    dvec3 point = AT(args.points, i).at;
    AngleSum sum = no_angle();
    for (uint edge = 0u; edge < args.edge_count; ++edge) sum = with_edge(sum, point, AT(args.edges, edge));
    AT(args.angles, i) = sum;
}
