// SPDX-License-Identifier: MIT
// Counts how often the scene winds around each point; crossings that float64 cannot decide are listed for the host.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_float64 : require
#include "twinray/glsl/common.glsl"
#include "shaders/collide/world_triangle.glsl"
#include "shaders/collide/orient.h"
#include "shaders/points/point_search.h"
#include "shaders/engine/list.glsl"
#include "shaders/points/found.glsl"
int volume_sign(dvec3 a, dvec3 b, dvec3 c, dvec3 d) { return filtered_volume_sign(a, b, c, d); }
int area_sign(dvec3 a, dvec3 b, dvec3 c, uint axis) { return filtered_area_sign(a, b, c, axis); }
#include "shaders/points/point_winding.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PointSearchArgs args; };

bool is_on_line(PointBox p, TreeBox box)
{
    return p.min.x <= box.max.x && p.min.y <= box.max.y && box.min.y <= p.max.y && p.min.z <= box.max.z &&
           box.min.z <= p.max.z;
}

void main()
{
    uint position = args.first + global_index();
    if (position >= args.end) return;
    uint i = AT(args.order, position);
    dvec3 point = AT(args.points, i).at;
    PointBox point_box = box_around(point);
    int winding = 0;
    uint end = args.leaf_begin + args.leaf_count;
    uint node = is_finite_point(point) ? 1u : 0u;
    while (node != 0u && node < end)
    {
        TreeBox box = AT(args.nodes, node);
        if (is_on_line(point_box, box))
        {
            if (node < args.leaf_begin)
            {
                node = 2u * node;
                continue;
            }
            int crossing = crossing_of(point, AT(args.triangles, box.item));
            if (crossing == UNKNOWN_SIGN) append(args, i, box.item, double(0.0f));
            else if (AT(args.runs, box.group).is_mirrored != 0u) winding -= crossing;
            else winding += crossing;
        }
        node = next_subtree(node);
    }
    AT(args.windings, i) = uint(winding);
}
