// SPDX-License-Identifier: MIT
// Finds all triangles that are not farther from each point than the limit.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/world_triangle.glsl"
#include "shaders/points/point_search.h"
#include "shaders/engine/list.glsl"
#include "shaders/points/found.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PointSearchArgs args; };

void main()
{
    uint position = args.first + global_index();
    if (position >= args.end) return;
    uint i = AT(args.order, position);
    dvec3 point = AT(args.points, i).at;
    if (!is_finite_point(point)) return;
    PointBox point_box = scaled(box_around(point), args.scale);
    double squared_limit = args.limit * args.limit;
    float limit_above = squared_distance_above(squared_limit, args.scale);
    uint end = args.leaf_begin + args.leaf_count;
    uint node = 1u;
    while (node != 0u && node < end)
    {
        TreeBox box = AT(args.nodes, node);
        if (!is_empty(box) && squared_distance_below(point_box, box, args.scale) <= limit_above)
        {
            if (node < args.leaf_begin)
            {
                node = 2u * node;
                continue;
            }
            double squared = closest_on_triangle(point, AT(args.triangles, box.item)).squared;
            if (squared <= squared_limit) append(args, i, box.item, sqrt(squared));
        }
        node = next_subtree(node);
    }
}
