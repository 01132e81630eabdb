// SPDX-License-Identifier: MIT
// Computes the boxes around instances whose areas are measured, in the order in which the driver takes them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/world_bound.h"
#include "shaders/shared/surface_area.h"
#include "shaders/shared/hw_tlas_header.h"
#include "shaders/shared/hw_build.h"
layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push { HwAreasArgs args; };

void main()
{
    uint position = global_index();
    if (position >= args.count) return;
    uint index = is_absent(args.instances) ? position : AT(args.instances, position).instance_index;
    bool is_unusable = false;
    GeometryBox box = instance_box(AT(args.records, index), is_unusable);
    AreaItem area = no_area();
    area.lo = box.lo;
    area.hi = box.hi;
    AT(args.areas, position) = area;
}
