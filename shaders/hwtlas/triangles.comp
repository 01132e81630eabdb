// SPDX-License-Identifier: MIT
// Prepares a mesh whose vertices move: its box around its active triangles, their Morton codes within it, for drivers
// that build in input order, and the driver's triangles in their build order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/hw_build.h"
layout(local_size_x = WORLD_BOUND_GROUP) in;
layout(push_constant, scalar) uniform Push { HwTrianglesArgs args; };

struct MeshTriangle {
    vec3 v0;
    vec3 v1;
    vec3 v2;
    bool is_active;
};

MeshTriangle load_triangle(HwTrianglesArgs mesh, uint triangle) {
    MeshTriangle t;
    uvec3 vertices = load_indices(mesh.indices, triangle);
    t.v0 = load_position(mesh.positions, vertices.x);
    t.v1 = load_position(mesh.positions, vertices.y);
    t.v2 = load_position(mesh.positions, vertices.z);
    t.is_active = is_active_triangle(t.v0, t.v1, t.v2);
    return t;
}

GeometryBox box_of(MeshTriangle t) {
    GeometryBox box;
    box.lo = min(t.v0, min(t.v1, t.v2));
    box.hi = max(t.v0, max(t.v1, t.v2));
    return box;
}

#ifdef KERNEL_TRIANGLE_BOUND
#include "shaders/engine/group_box.glsl"

void main() {
    if (group_index() >= args.group_count) return;
    GeometryBox box = no_box();
    if (global_index() < args.count) {
        MeshTriangle triangle = load_triangle(args, global_index());
        if (triangle.is_active) box = box_of(triangle);
    }
    if (!add_box(args.bits, args.group_count, box)) return;
    GeometryBox whole = whole_box(args.bits);
    AT(args.geometry, 0).lo = whole.lo;
    AT(args.geometry, 0).hi = whole.hi;
}
#endif

#ifdef KERNEL_TRIANGLE_CODES
const uint LAST = 0x3fffffffu;  // for triangles that cannot be hit

void main() {
    uint index = global_index();
    if (index >= args.count) return;
    MeshTriangle triangle = load_triangle(args, index);
    GeometryBox box = box_of(triangle);
    HwGeometry geometry = AT(args.geometry, 0);
    AT(args.keys, index) =
        triangle.is_active ? morton_code(box.lo * 0.5f + box.hi * 0.5f, geometry.lo, geometry.hi) : LAST;
}
#endif

#ifdef KERNEL_GATHER_TRIANGLES
// An inactive triangle is collapsed to a point inside the box of the others: see hwtlas/blas.h.
void store(uint vertex, vec3 position) {
    AT(args.vertices, vertex * 3u) = position.x;
    AT(args.vertices, vertex * 3u + 1u) = position.y;
    AT(args.vertices, vertex * 3u + 2u) = position.z;
}

void main() {
    uint position = global_index();
    if (position >= args.count) return;
    bool has_table = !is_absent(args.table);
    bool has_order = !is_absent(args.order);
    uint index = has_order ? AT(args.order, position) : (has_table ? AT(args.table, position) : position);
    if (has_order) AT(args.table, position) = index;
    MeshTriangle triangle = load_triangle(args, index);
    AreaItem area = no_area();
    if (triangle.is_active) {
        GeometryBox box = box_of(triangle);
        area.lo = box.lo;
        area.hi = box.hi;
    } else {
        HwGeometry geometry = AT(args.geometry, 0);
        vec3 anchor = geometry.lo.x <= geometry.hi.x ? geometry.lo : vec3(0.0f);
        triangle.v0 = anchor;
        triangle.v1 = anchor;
        triangle.v2 = anchor;
    }
    AT(args.areas, position) = area;
    store(3u * position, triangle.v0);
    store(3u * position + 1u, triangle.v1);
    store(3u * position + 2u, triangle.v2);
}
#endif
