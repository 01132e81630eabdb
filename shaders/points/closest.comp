// SPDX-License-Identifier: MIT
// Finds the triangle closest to each point; of several, the one of lowest number. Near children come first; bit k of
// `waiting` says that the sibling of the node k levels up is still to be searched.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/collide/world_triangle.glsl"
#include "shaders/points/point_search.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PointSearchArgs args; };

dvec3 point;
PointBox point_box;
TrianglePoint best;  // its `squared` is the limit until an item is found
uint best_item = NO_ITEM;
float best_above;  // best.squared in the form of bounds of boxes

float nothing() { return uintBitsToFloat(0x7f800000u); }  // the bound of an empty box

float bound_of(uint node) {
    if (node >= args.leaf_begin + args.leaf_count) return nothing();
    TreeBox box = AT(args.nodes, node);
    return is_empty(box) ? nothing() : squared_distance_below(point_box, box, args.scale);
}

void test(uint leaf) {
    uint item = AT(args.nodes, leaf).item;
    TrianglePoint found = closest_on_triangle(point, AT(args.triangles, item));
    if (found.squared > best.squared || (found.squared == best.squared && item > best_item)) return;
    best = found;
    best_item = item;
    best_above = squared_distance_above(found.squared, args.scale);
}

// Returns the next node that is near enough; 0: there is none.
uint next_waiting(uint node, inout uint waiting) {
    while (waiting != 0u) {
        int up = findLSB(waiting);
        node = (node >> up) ^ 1u;
        waiting = (waiting >> up) & ~1u;
        if (bound_of(node) <= best_above) return node;
    }
    return 0u;
}

void search() {
    uint node = bound_of(1u) <= best_above ? 1u : 0u;
    uint waiting = 0u;
    while (node != 0u) {
        if (node >= args.leaf_begin) {
            test(node);
            node = next_waiting(node, waiting);
            continue;
        }
        float left = bound_of(2u * node);
        float right = bound_of(2u * node + 1u);
        float near = min(left, right);
        float far = max(left, right);
        if (near > best_above) {
            node = next_waiting(node, waiting);
            continue;
        }
        node = 2u * node + (left <= right ? 0u : 1u);
        waiting = waiting << 1u | (far <= best_above ? 1u : 0u);
    }
}

void main() {
    uint position = args.first + global_index();
    if (position >= args.end) return;
    uint i = AT(args.order, position);
    point = AT(args.points, i).at;
    point_box = scaled(box_around(point), args.scale);
    best.squared = args.limit * args.limit;
    best_above = squared_distance_above(best.squared, args.scale);
    if (is_finite_point(point)) search();
    ClosestItem closest;
    closest.at = point + best.offset;
    closest.distance = sqrt(best.squared);
    closest.uv = best.uv;
    closest.item = best_item;
    closest.reserved = 0u;
    AT(args.closest, i) = closest;
}
