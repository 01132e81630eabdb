// SPDX-License-Identifier: MIT
// Computes Morton codes of instances, by which they are presorted.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/world_bound.h"
#include "shaders/shared/hw_tlas_header.h"
layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push { HwCodesArgs args; };

// The code of an instance that cannot be hit: from Mesa 26.1 on, lavapipe confuses instances if an inactive one comes
// before an active one.
const uint LAST = 0x3fffffffu;

uint code_of(InstanceRecord record)
{
    if (!has_geometry(record) || mask_of(record) == 0u) return LAST;
    GeometryBox box = AT(REF(GeometryBox)(record.geometry), 0);
    Rows to_world = to_world_of(record);
    if (!(box.lo.x <= box.hi.x) || !is_usable(to_world, inverse_of(to_world))) return LAST;
    precise vec3 middle = box.lo * 0.5f + box.hi * 0.5f; // halved first: their sum might not be finite
    vec3 center = transform_point(to_world, middle);
    WorldBound bound = AT(args.bound, 0);
    return min(morton_code(center, bound.lo, bound.hi), LAST - 1u);
}

void main()
{
    uint index = global_index();
    if (index >= args.count) return;
    AT(args.keys, index) = code_of(in_built_units(AT(args.records, index)));
}
