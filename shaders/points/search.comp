// SPDX-License-Identifier: MIT
// Boxes around points; the triangles that are not farther from each point than the limit; how often the scene winds
// around each point, where crossings that float64 cannot decide are listed for the host.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/collide/world_triangle.glsl"
#include "shaders/points/point_search.h"
#include "shaders/points/point_winding.h"
#include "shaders/engine/list.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PointSearchArgs args; };

void append(PointSearchArgs args, uint point, uint item, double distance) {
    uint slot = append_to(args.total);
    if (slot >= args.capacity) return;
    AT(args.found, slot).point = point;
    AT(args.found, slot).item = item;
    AT(args.found, slot).distance = distance;
}

#ifdef KERNEL_BOXES
void main() {
    uint i = global_index();
    if (i < args.end) AT(args.boxes, i) = tree_box_of(AT(args.points, i).at, i);
}
#endif

#ifdef KERNEL_WITHIN
void main() {
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
    while (node != 0u && node < end) {
        TreeBox box = AT(args.nodes, node);
        if (!is_empty(box) && squared_distance_below(point_box, box, args.scale) <= limit_above) {
            if (node < args.leaf_begin) {
                node = 2u * node;
                continue;
            }
            double squared = closest_on_triangle(point, AT(args.triangles, box.item)).squared;
            if (squared <= squared_limit) append(args, i, box.item, sqrt(squared));
        }
        node = next_subtree(node);
    }
}
#endif

#ifdef KERNEL_WINDING
bool is_on_line(PointBox p, TreeBox box) {
    return p.min.x <= box.max.x && p.min.y <= box.max.y && box.min.y <= p.max.y && p.min.z <= box.max.z &&
           box.min.z <= p.max.z;
}

void main() {
    uint position = args.first + global_index();
    if (position >= args.end) return;
    uint i = AT(args.order, position);
    dvec3 point = AT(args.points, i).at;
    PointBox point_box = box_around(point);
    int winding = 0;
    uint end = args.leaf_begin + args.leaf_count;
    uint node = is_finite_point(point) ? 1u : 0u;
    while (node != 0u && node < end) {
        TreeBox box = AT(args.nodes, node);
        if (is_on_line(point_box, box)) {
            if (node < args.leaf_begin) {
                node = 2u * node;
                continue;
            }
            int crossing = crossing_of(point, AT(args.triangles, box.item));
            if (crossing == UNKNOWN_SIGN)
                append(args, i, box.item, double(0.0f));
            else if (AT(args.runs, box.group).is_mirrored != 0u)
                winding -= crossing;
            else
                winding += crossing;
        }
        node = next_subtree(node);
    }
    AT(args.windings, i) = uint(winding);
}
#endif
