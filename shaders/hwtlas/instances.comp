// SPDX-License-Identifier: MIT
// Prepares a top level: the Morton codes of instances, by which they are presorted, the instances as the driver takes
// them, and the boxes around them whose areas are measured.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/hw_build.h"
layout(local_size_x = 256) in;

#ifdef KERNEL_INSTANCE_CODES
layout(push_constant, scalar) uniform Push { HwCodesArgs args; };

// The code of an instance that cannot be hit: from Mesa 26.1 on, lavapipe confuses instances if an inactive one comes
// before an active one.
const uint LAST = 0x3fffffffu;

uint code_of(InstanceRecord record) {
    if (!has_geometry(record) || mask_of(record) == 0u) return LAST;
    GeometryBox box = AT(REF(GeometryBox)(record.geometry), 0);
    Rows to_world = to_world_of(record);
    if (!(box.lo.x <= box.hi.x) || !is_usable(to_world, inverse_of(to_world))) return LAST;
    precise vec3 middle = box.lo * 0.5f + box.hi * 0.5f;  // halved first: their sum might not be finite
    vec3 center = transform_point(to_world, middle);
    WorldBound bound = AT(args.bound, 0);
    return min(morton_code(center, bound.lo, bound.hi), LAST - 1u);
}

void main() {
    uint index = global_index();
    if (index >= args.count) return;
    AT(args.keys, index) = code_of(in_built_units(AT(args.records, index)));
}
#endif

#ifdef KERNEL_GATHER_INSTANCES
layout(push_constant, scalar) uniform Push { HwGatherArgs args; };

// Returns the index of the record at a position.
uint index_at(uint position) {
    if (args.count == 1u) return 0u;
    if (!is_absent(args.order)) return AT(args.order, position);
    return is_absent(args.instances) ? position : AT(args.instances, position).instance_index;
}

void main() {
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
    record.sbt_offset_flags |= geometry.kind;  // the hit group of a pipeline
    AT(args.driver_records, position) = record;
    if (is_absent(args.instances)) return;
    HwInstance instance;
    if (usable)
        instance.triangles = geometry.triangles;
    else
        instance.triangles = Uints(absent_near(args.records.address));
    instance.instance_index = index;
    instance.pad = 0u;
    AT(args.instances, position) = instance;
}
#endif

#ifdef KERNEL_INSTANCE_AREAS
// Measures in the order in which the driver takes them.
layout(push_constant, scalar) uniform Push { HwAreasArgs args; };

void main() {
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
#endif
