// SPDX-License-Identifier: MIT
// A ray in the space of an instance, or of the top level, and what traversal must know of the instance that it is in.
#ifndef TWINRAY_SHARED_LOCAL_RAY_H
#define TWINRAY_SHARED_LOCAL_RAY_H
#include "shaders/shared/bvh.h"
#include "shaders/shared/ray_space.h"
#include "shaders/shared/trace.h"
#include "twinray/glsl/transform.h"
#ifdef TWINRAY_REFINED
#include "shaders/shared/certified.h"
#endif

// Rounding of the world-to-object transform moves a ray by a few roundings of its origin's size, and the limit of
// reciprocals by 2^-40 of the way. `extent`: the largest coordinate of the scene.
FUNC float world_pad(vec3 origin, float extent)
{
    return largest_entry(origin) * 9.5367431640625e-07f + extent * 3.637978807091713e-12f; // 2^-20, 2^-38
}

// Which side an instance's triangles hide from a ray: CULL_FRONT, CULL_BACK or 0.
FUNC uint culled_side(uint ray_flags, uint instance_flags)
{
    uint side = ray_flags & (CULL_BACK | CULL_FRONT);
    if (side == 0u || (instance_flags & INSTANCE_DISABLE_CULLING) != 0u) return 0u;
    return (instance_flags & INSTANCE_FLIP_FACING) != 0u ? side ^ (CULL_BACK | CULL_FRONT) : side;
}

// What traversal must know of the instance it is in. Features are asked for where these are read, not where they are
// set: only so compilers see across the loop that what depends on them is never run.
struct InInstance
{
    uint index;
    uint custom_index;
    uint culled; // side of its triangles that is not hit
    bool has_boxes;
    bool is_non_opaque;
    bool is_flipped; // what culling takes for the front of its triangles is the back
    float error; // at LEVEL_CERTIFIED: see CertifiedRay; else 0
};

FUNC InInstance enter_instance(SwInstance instance, uint index, TraceOptions options)
{
    InInstance inside;
    inside.index = index;
    inside.custom_index = instance.custom_index_mask & 0xffffffu;
    inside.culled = culled_side(options.flags, instance.flags);
    inside.has_boxes = instance.kind == GEOMETRY_BOXES;
    inside.error = 0.0f;
    inside.is_flipped = (instance.flags & INSTANCE_FLIP_FACING) != 0u;
    inside.is_non_opaque = (instance.flags & INSTANCE_NON_OPAQUE) != 0u || (options.flags & ALL_NON_OPAQUE) != 0u;
    return inside;
}

FUNC InInstance in_no_instance()
{
    InInstance inside;
    inside.index = NOTHING;
    inside.custom_index = 0u;
    inside.culled = 0u;
    inside.has_boxes = false;
    inside.is_non_opaque = false;
    inside.is_flipped = false;
    inside.error = 0.0f;
    return inside;
}

// Adding 0 takes a zero's sign, which the sums of a transform may change: with the identity, too, both ways give the
// same bits.
FUNC vec3 without_negative_zeros(vec3 v)
{
    PRECISE vec3 sum = v + vec3(0.0f);
    return sum;
}

// A ray in the space of a tree, and how far off its boxes may be met (see make_ray_space).
struct LocalRay
{
    vec3 origin;
    vec3 direction;
    float pad;
};

FUNC LocalRay ray_in_world(SwTlasHeader scene, Ray ray)
{
    LocalRay local;
    local.origin = ray.origin;
    local.direction = ray.direction;
    local.pad = world_pad(ray.origin, largest_coordinate(scene.bvh.lo, scene.bvh.hi));
    return local;
}

FUNC RaySpace space_of(LocalRay ray) { return make_ray_space(ray.origin, ray.direction, ray.pad); }

// In the space of the instance's geometry.
FUNC LocalRay ray_in_instance(SwInstance instance, INOUT(InInstance) inside, Ray ray, TraceOptions options)
{
    LocalRay local;
#ifdef TWINRAY_REFINED
    if (options.level == LEVEL_CERTIFIED)
    {
        CertifiedRay mapped = certified_ray(AT(options.instances, inside.index), ray, options.advance != double(0.0f));
        inside.error = mapped.error;
        local.origin = mapped.origin;
        local.direction = mapped.direction;
        local.pad = mapped.error;
        return local;
    }
#endif
    vec3 origin = ray.origin;
    vec3 direction = ray.direction;
    if ((options.features & FEATURE_TRANSFORMS) != 0u)
    {
        origin = transform_point(instance.world_to_object, origin);
        direction = transform_vector(instance.world_to_object, direction);
    }
    local.origin = without_negative_zeros(origin);
    local.direction = without_negative_zeros(direction);
    local.pad = vertex_pad(local.origin, instance.extent);
    return local;
}
#endif
