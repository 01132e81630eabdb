// SPDX-License-Identifier: MIT
// The scene data of levels from refined on: meshes and transforms as they were given.
#ifndef TWINRAY_SHARED_REFINE_SCENE_H
#define TWINRAY_SHARED_REFINE_SCENE_H
#include "shaders/shared/transform_double.h"
#include "shaders/shared/world_bound.h"

// The data of an instance that refining needs.
struct RefineInstance {
    InstancedMesh placed;  // as given, in units of a power of two, which the map contains; absent: boxes
    RowsDouble world_to_object;
    float residual;    // the relative error of vectors that it maps, at most
    float extent;      // the largest coordinate of the geometry's box
    uint is_mirrored;  // 1 where the map's determinant is negative
    uint reserved;
};
BUFFER_OF(RefineInstance, 16);

struct RefineScene {
    REF(WorldBound) bound;
    REF(RefineInstance) instances;  // in the order of Hit::instance_index
};
BUFFER_OF(RefineScene, 8);

struct RefineGatherArgs {
    REF(InstanceRecord) records;
    REF(RefineInstance) instances;
    uint count;
    uint reserved;
};

// Returns the data of an instance that refining needs; its record is in built units. `absent` is the address that
// replaces that of a missing mesh.
FUNC RefineInstance refine_instance(InstanceRecord record, Address absent) {
    const float UP = 1.00000095367431640625f;  // 1 + 2^-20: more than rounding to float32 takes
    Rows to_world = to_world_of(record);
    RefineInstance instance;
    instance.placed.object_to_world = to_world;
    instance.placed.mesh.positions = Floats(absent);
    instance.placed.mesh.indices = Uints(absent);
    instance.extent = 0.0f;
    if (has_geometry(record)) {
        instance.placed.mesh = AT(REF(GeometrySource)(address_after(record.geometry, GEOMETRY_SOURCE_OFFSET)), 0).mesh;
        GeometryBox box = AT(REF(GeometryBox)(record.geometry), 0);
        instance.extent = box.lo.x <= box.hi.x ? max(largest_entry(box.lo), largest_entry(box.hi)) : 0.0f;
    }
    instance.world_to_object = inverse_double(to_world);
    instance.residual = float(residual_of(instance.world_to_object, to_world)) * UP;
    dvec3 normal = cross_product(linear_double(to_world.r0), linear_double(to_world.r1));
    instance.is_mirrored = product_sum(normal, linear_double(to_world.r2)) < double(0.0f) ? 1u : 0u;
    instance.reserved = 0u;
    return instance;
}
#endif
