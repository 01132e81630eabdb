// SPDX-License-Identifier: MIT
// Triangles where instances put them: corners in float64, and boxes around them, rounded outward.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/world_corner.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { WorldTrianglesArgs args; };

// The last mesh that does not begin after `triangle`.
uint mesh_of(uint triangle)
{
    uint low = 0u;
    uint high = args.mesh_count;
    while (high - low > 1u)
    {
        uint middle = (low + high) / 2u;
        if (AT(args.meshes, middle).first_triangle <= triangle) low = middle;
        else high = middle;
    }
    return low;
}

void main()
{
    uint i = global_index();
    if (i >= args.count) return;
    uint index = mesh_of(i);
    PlacedMesh placed = AT(args.meshes, index);
    uvec3 vertices = vertices_of(placed, i - placed.first_triangle);
    Corners64 corners = world_corners(placed, vertices);
    TriangleName name;
    name.corners = vertices;
    if (!is_null(placed.vertex_ids))
        name.corners = uvec3(AT(placed.vertex_ids, vertices.x), AT(placed.vertex_ids, vertices.y),
                             AT(placed.vertex_ids, vertices.z));
    name.placed = index;
    AT(args.corners, i) = corners;
    AT(args.names, i) = name;
    AT(args.boxes, i) = box_around(corners, i, index);
}
