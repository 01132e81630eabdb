// SPDX-License-Identifier: MIT
// Computes Morton codes of the triangles within the mesh's box, for drivers that build in input order.
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

const uint LAST = 0x3fffffffu; // for triangles that cannot be hit

void main()
{
    uint index = global_index();
    if (index >= args.count) return;
    MeshTriangle triangle = load_triangle(args, index);
    GeometryBox box = box_of(triangle);
    HwGeometry geometry = AT(args.geometry, 0);
    AT(args.keys, index) =
        triangle.is_active ? morton_code(box.lo * 0.5f + box.hi * 0.5f, geometry.lo, geometry.hi) : LAST;
}
