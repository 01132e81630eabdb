// SPDX-License-Identifier: MIT
// Writes the driver's triangles in their build order. An inactive triangle is collapsed to a point inside the box of
// the others: see hwtlas/blas.h.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/world_bound.h"
#include "shaders/shared/surface_area.h"
#include "shaders/shared/hw_tlas_header.h"
#include "shaders/shared/hw_build.h"
#include "shaders/hwtlas/mesh_triangle.glsl"
layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push { HwTrianglesArgs args; };

void store(uint vertex, vec3 position)
{
    AT(args.vertices, vertex * 3u) = position.x;
    AT(args.vertices, vertex * 3u + 1u) = position.y;
    AT(args.vertices, vertex * 3u + 2u) = position.z;
}

void main()
{
    uint position = global_index();
    if (position >= args.count) return;
    bool has_table = !is_absent(args.table);
    bool has_order = !is_absent(args.order);
    uint index = has_order ? AT(args.order, position) : (has_table ? AT(args.table, position) : position);
    if (has_order) AT(args.table, position) = index;
    MeshTriangle triangle = load_triangle(args, index);
    AreaItem area = no_area();
    if (triangle.is_active)
    {
        GeometryBox box = box_of(triangle);
        area.lo = box.lo;
        area.hi = box.hi;
    }
    else
    {
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
