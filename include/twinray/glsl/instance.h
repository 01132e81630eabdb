// SPDX-License-Identifier: MIT
// One placement of a geometry: the bytes of VkAccelerationStructureInstanceKHR, read by both accelerators.
#ifndef TWINRAY_INSTANCE_H
#define TWINRAY_INSTANCE_H
#include "twinray/glsl/rays.h"
#include "twinray/glsl/transform.h"

// An instance as kernels may write it: AbstractAccel::instance_buffer().
struct InstanceRecord {
    Rows object_to_world;
    uint custom_index_mask;  // 24-bit custom index, 8-bit mask in the high byte
    uint sbt_offset_flags;   // 24-bit shader binding table offset (0), 8-bit VkGeometryInstanceFlagsKHR
    Address geometry;        // address of the accelerator's block for the geometry; 0 = inactive
};
BUFFER_OF(InstanceRecord, 16);

// The start of every geometry's block: a box around its active triangles in object space. lo > hi: it has none.
struct GeometryBox {
    vec3 lo;
    vec3 hi;
};
BUFFER_OF(GeometryBox, 8);

// A mesh in device memory: 3 floats a vertex, 3 indices a triangle.
struct PackedMesh {
    Floats positions;
    Uints indices;
};

// A mesh as an instance places it.
struct InstancedMesh {
    Rows object_to_world;
    PackedMesh mesh;
};

// The next part of every geometry's block, at GEOMETRY_SOURCE_OFFSET, for both accelerators. Meshes are built in units
// of `scale`, a power of two near their size, so that neither tiny nor huge ones leave the range of float32; the map to
// world space includes the unit.
struct GeometrySource {
    PackedMesh mesh;  // in units of scale; absent unless AccelOptions keep level refined or surfaces
    float scale;
    uint reserved;
};
BUFFER_OF(GeometrySource, 8);
const uint GEOMETRY_SOURCE_OFFSET = 72u;

// Flags of an instance, with the values of VkGeometryInstanceFlagBitsKHR. The front of a triangle is the side
// that (v1 - v0) x (v2 - v0) points to, in object space; TURNED exchanges front and back.
const uint INSTANCE_DISABLE_CULLING = 1u;
const uint INSTANCE_FLIP_FACING = 2u;
const uint INSTANCE_NON_OPAQUE = 8u;  // not opaque: the trace program decides about each hit

// The kind of a geometry.
const uint GEOMETRY_TRIANGLES = 0u;
const uint GEOMETRY_BOXES = 1u;

// Returns the bits of VkGeometryInstanceFlagBitsKHR.
FUNC uint flags_of(InstanceRecord instance) { return instance.sbt_offset_flags >> 24u; }
FUNC uint custom_index_of(InstanceRecord instance) { return instance.custom_index_mask & 0xffffffu; }  // 24 bits
FUNC uint mask_of(InstanceRecord instance) { return instance.custom_index_mask >> 24u; }               // 8 bits

// Returns whether the instance has a geometry: kernels that write instances may remove it.
FUNC bool has_geometry(InstanceRecord instance) { return instance.geometry != NULL_ADDRESS; }

// Returns the map from object space to world space.
FUNC Rows to_world_of(InstanceRecord instance) { return instance.object_to_world; }

// Returns the row with its linear part in units of `scale`.
FUNC vec4 scaled_row(vec4 row, float scale) { return vec4(row.x * scale, row.y * scale, row.z * scale, row.w); }
// Returns the map of points in units of `scale`.
FUNC Rows scaled_map(Rows m, float scale) {
    m.r0 = scaled_row(m.r0, scale);
    m.r1 = scaled_row(m.r1, scale);
    m.r2 = scaled_row(m.r2, scale);
    return m;
}

// Returns the instance in the units of the built geometry instead of the given ones.
FUNC InstanceRecord in_built_units(InstanceRecord instance) {
    if (has_geometry(instance)) {
        float scale = AT(REF(GeometrySource)(address_after(instance.geometry, GEOMETRY_SOURCE_OFFSET)), 0).scale;
        instance.object_to_world = scaled_map(instance.object_to_world, scale);
    }
    return instance;
}

// Returns whether no entry of a map is infinite or NaN. An instance is inactive if its transform or its inverse has
// such an entry: kernels also write transforms and cannot throw.
FUNC bool is_finite_map(Rows m) {
    return is_finite(vec3(m.r0.x, m.r0.y, m.r0.z)) && is_finite(vec3(m.r1.x, m.r1.y, m.r1.z)) &&
           is_finite(vec3(m.r2.x, m.r2.y, m.r2.z)) && is_finite(vec3(m.r0.w, m.r1.w, m.r2.w));
}
// Returns whether an instance with this map and its inverse can be hit: both are finite.
FUNC bool is_usable(Rows to_world, Rows to_object) { return is_finite_map(to_world) && is_finite_map(to_object); }
#endif
