// SPDX-License-Identifier: MIT
// What refining needs of each instance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/refine_scene.h"
layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push { RefineGatherArgs args; };

void main()
{
    uint i = global_index();
    if (i >= args.count) return;
    InstanceRecord record = in_built_units(AT(args.records, i));
    GeometrySource mesh = AT(REF(GeometrySource)(record.geometry + uint64_t(GEOMETRY_SOURCE_OFFSET)), 0);
    RefineInstance instance;
    instance.object_to_world = record.object_to_world;
    instance.positions = mesh.positions;
    instance.indices = mesh.indices;
    GeometryBox box = AT(REF(GeometryBox)(record.geometry), 0);
    instance.extent = box.lo.x <= box.hi.x ? max(largest_entry(box.lo), largest_entry(box.hi)) : 0.0f;
    Rows to_world = to_world_of(record);
    instance.world_to_object = inverse_double(to_world);
    instance.residual = float(residual_of(instance.world_to_object, to_world)) * 1.00000095367431640625f; // 1 + 2^-20: rounded up
    dvec3 normal = cross_product(linear_double(to_world.r0), linear_double(to_world.r1));
    instance.is_mirrored = product_sum(normal, linear_double(to_world.r2)) < 0.0 ? 1u : 0u;
    instance.reserved = 0u;
    AT(args.instances, i) = instance;
}
