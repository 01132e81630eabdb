// SPDX-License-Identifier: MIT
// Computes the box of a mesh, around its active triangles.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/world_bound.h"
#include "shaders/shared/surface_area.h"
#include "shaders/shared/hw_tlas_header.h"
#include "shaders/shared/hw_build.h"
#include "shaders/hwtlas/mesh_triangle.glsl"
layout(local_size_x = WORLD_BOUND_GROUP) in;
#include "shaders/engine/group_box.glsl"
layout(push_constant, scalar) uniform Push { HwTrianglesArgs args; };

void main()
{
    if (group_index() >= args.group_count) return;
    GeometryBox box = no_box();
    if (global_index() < args.count)
    {
        MeshTriangle triangle = load_triangle(args, global_index());
        if (triangle.is_active) box = box_of(triangle);
    }
    if (!add_box(args.bits, args.group_count, box)) return;
    GeometryBox whole = whole_box(args.bits);
    AT(args.geometry, 0).lo = whole.lo;
    AT(args.geometry, 0).hi = whole.hi;
}
