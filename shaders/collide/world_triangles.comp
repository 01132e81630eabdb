// SPDX-License-Identifier: MIT
// Computes triangles as instances place them: vertices in float64, and boxes around them, rounded outward.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/collide/world_triangle.glsl"
#include "shaders/collide/world_vertex.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { WorldTrianglesArgs args; };

// Returns the last run that does not begin after `triangle`.
uint run_of(uint triangle) {
    uint low = 0u;
    uint high = args.run_count;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (AT(args.runs, middle).first_triangle <= triangle)
            low = middle;
        else
            high = middle;
    }
    return low;
}

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    uint index = run_of(i);
    TriangleRun run = AT(args.runs, index);
    uvec3 indices = indices_of(run, i - run.first_triangle);
    WorldTriangle triangle = world_triangle(run, indices);
    TriangleName name;
    name.vertices = indices;
    if (!is_absent(run.vertex_ids))
        name.vertices =
            uvec3(AT(run.vertex_ids, indices.x), AT(run.vertex_ids, indices.y), AT(run.vertex_ids, indices.z));
    name.run = index;
    AT(args.triangles, i) = triangle;
    AT(args.names, i) = name;
    AT(args.boxes, i) = box_around(triangle, i, index);
}
