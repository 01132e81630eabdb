// SPDX-License-Identifier: MIT
// Makes the rays of a run of cells.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/analysis/ray_grid.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { GridRaysArgs args; };

void main()
{
    uint i = global_index();
    if (i < args.count) AT(args.rays, i) = grid_ray(args.grid, args.first + i);
}
