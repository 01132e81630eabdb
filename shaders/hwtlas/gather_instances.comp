// SPDX-License-Identifier: MIT
// Writes the instances as the driver takes them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/world_bound.h"
#include "shaders/shared/surface_area.h"
#include "shaders/shared/hw_tlas_header.h"
#include "shaders/shared/hw_build.h"
layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push { HwGatherArgs args; };

// Returns the index of the record at a position.
uint index_at(uint position)
{
    if (args.count == 1u) return 0u;
    if (!is_absent(args.order)) return AT(args.order, position);
    return is_absent(args.instances) ? position : AT(args.instances, position).instance_index;
}

void main()
{
    uint position = global_index();
    if (position >= args.count) return;
    uint index = index_at(position);
    InstanceRecord record = in_built_units(AT(args.records, index));
    Rows to_world = to_world_of(record);
    bool usable = has_geometry(record) && is_usable(to_world, inverse_of(to_world));
    HwGeometry geometry;
    geometry.kind = GEOMETRY_TRIANGLES;
    if (usable) geometry = AT(REF(HwGeometry)(record.geometry), 0);
    record.geometry = usable ? geometry.blas : NULL_ADDRESS;
    record.sbt_offset_flags |= geometry.kind; // the hit group of a pipeline
    AT(args.driver_records, position) = record;
    if (is_absent(args.instances)) return;
    HwInstance instance;
    if (usable) instance.triangles = geometry.triangles;
    else instance.triangles = Uints(absent_near(args.records.address));
    instance.instance_index = index;
    instance.pad = 0u;
    AT(args.instances, position) = instance;
}
