// SPDX-License-Identifier: MIT
// Writes the instances as the driver takes them, and the boxes around them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/world_bound.h"
#include "shaders/shared/surface_area.h"
#include "shaders/shared/hw_tlas_header.h"
#include "shaders/shared/hw_build.h"
layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push { HwGatherArgs args; };

void main()
{
    uint position = global_index();
    if (position >= args.count) return;
    bool has_table = !is_absent(args.instances);
    bool has_order = !is_absent(args.order);
    uint index = position;
    if (has_order) index = AT(args.order, position);
    else if (has_table) index = AT(args.instances, position).instance_index;
    InstanceRecord record = in_built_units(AT(args.records, index));
    Rows to_world = to_world_of(record);
    bool usable = has_geometry(record) && is_usable(to_world, inverse_of(to_world));
    HwGeometry geometry;
    geometry.kind = GEOMETRY_TRIANGLES;
    if (usable) geometry = AT(REF(HwGeometry)(record.geometry), 0);
    AreaItem area = no_area();
    if (usable && geometry.lo.x <= geometry.hi.x)
    {
        GeometryBox box;
        box.lo = geometry.lo;
        box.hi = geometry.hi;
        box = box_in_world(box, to_world);
        area.lo = box.lo;
        area.hi = box.hi;
    }
    if (!is_absent(args.areas)) AT(args.areas, position) = area;
    if (is_absent(args.driver_records)) return;
    record.geometry = usable ? geometry.blas : NULL_ADDRESS;
    record.sbt_offset_flags |= geometry.kind; // the hit group of a pipeline
    AT(args.driver_records, position) = record;
    if (!has_table) return;
    HwInstance instance;
    if (usable) instance.triangles = geometry.triangles;
    else instance.triangles = Uints(absent_near(args.records.address));
    instance.instance_index = index;
    instance.pad = 0u;
    AT(args.instances, position) = instance;
}
