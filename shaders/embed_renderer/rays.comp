// SPDX-License-Identifier: MIT
// Shadow and ambient occlusion rays of the pixels that show a surface, packed into two lists. The point is computed
// again from its triangle, not from depth: then its rounding error has a bound, and rays leave without an epsilon.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/embed_renderer/pixels.glsl"
layout(push_constant, scalar) uniform Push { RaysArgs args; };

// Where a ray meets the plane of a triangle, moved into the triangle: a pixel's centre may lie outside it by the
// rasteriser's rounding.
vec2 barycentrics(vec3 origin, vec3 direction, vec3 a, vec3 b, vec3 c)
{
    vec3 edge1 = b - a;
    vec3 edge2 = c - a;
    vec3 p = cross(direction, edge2);
    vec3 from_a = origin - a;
    float determinant = dot(edge1, p);
    float u = clamp(dot(from_a, p) / determinant, 0.0, 1.0);
    float v = clamp(dot(direction, cross(from_a, edge1)) / determinant, 0.0, 1.0 - u);
    return determinant == 0.0 ? vec2(0.0) : vec2(u, v);
}

SurfacePoint visible_point(CameraRays camera, vec3 direction, uvec2 ids)
{
    SurfaceInstance instance = AT(AT(args.frame, 0).instances, ids.x);
    uvec3 indices = AT(instance.triangles, ids.y).vertices;
    Placement placement;
    placement.to_world = instance.object_to_world;
    placement.to_object = instance.world_to_object;
    TriangleVertices vertices;
    vertices.a = AT(instance.vertices, indices.x).position;
    vertices.b = AT(instance.vertices, indices.y).position;
    vertices.c = AT(instance.vertices, indices.z).position;
    vec3 origin = transform_point(placement.to_object, camera.origin);
    vec3 along = transform_vector(placement.to_object, direction);
    return surface_point(placement, vertices, barycentrics(origin, along, vertices.a, vertices.b, vertices.c));
}

Ray ray_to(SurfacePoint point, vec3 direction, float t_max)
{
    Ray ray;
    ray.origin = spawn_position(point, dot(direction, point.normal) > 0.0);
    ray.t_min = 0.0;
    ray.direction = direction;
    ray.t_max = t_max;
    return ray;
}

void add_shadow_rays(uint first, uint pixel, SurfacePoint point)
{
    FrameData frame = AT(args.frame, 0);
    Frame about = frame_about(frame.sun_direction);
    for (uint i = 0u; i < frame.shadow_rays; ++i)
    {
        vec2 u = unit_floats(sample_pair(pixel, i, 0u, 1u));
        vec2 disc = unit_circle(u.y) * (sqrt(u.x) * frame.sun_spread);
        vec3 direction = normalize(to_world(about, vec3(disc, 1.0)));
        AT(args.shadow_rays, first + i) = ray_to(point, direction, uintBitsToFloat(0x7f800000u));
    }
}

void add_ao_rays(uint first, uint pixel, SurfacePoint point, vec3 normal, vec3 outside)
{
    FrameData frame = AT(args.frame, 0);
    Frame about = frame_about(normal);
    for (uint i = 0u; i < frame.ao_rays; ++i)
    {
        vec3 direction = to_world(about, sample_cosine_hemisphere(unit_floats(sample_pair(pixel, i, 1u, 1u))));
        // The shading normal's hemisphere reaches behind the triangle.
        float below = dot(direction, outside);
        if (below < 0.0) direction -= 2.0 * below * outside;
        AT(args.ao_rays, first + i) = ray_to(point, direction, frame.ao_radius);
    }
}

void main()
{
    FrameData frame = AT(args.frame, 0);
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width || pixel.y >= frame.height) return;
    uint index = pixel.y * frame.width + pixel.x;
    PixelRays slots;
    slots.shadow = NO_SLOT;
    slots.ao = NO_SLOT;
    uvec2 ids = texelFetch(ids_target, ivec2(pixel), 0).xy;
    if (ids.x != BACKGROUND)
    {
        vec3 view = view_direction(frame.camera, pixel, vec2(frame.width, frame.height));
        SurfacePoint point = visible_point(frame.camera, view, ids);
        vec3 outside = dot(point.normal, view) > 0.0 ? -point.normal : point.normal;
        vec3 normal = texelFetch(normal_target, ivec2(pixel), 0).xyz;
        normal = normalize(dot(normal, outside) < 0.0 ? -normal : normal);
        if (frame.shadow_rays > 0u && min(dot(normal, frame.sun_direction), dot(outside, frame.sun_direction)) > 0.0)
        {
            slots.shadow = atomicAdd(AT(args.counts, 0).shadow, frame.shadow_rays);
            add_shadow_rays(slots.shadow, index, point);
        }
        if (frame.ao_rays > 0u)
        {
            slots.ao = atomicAdd(AT(args.counts, 0).ao, frame.ao_rays);
            add_ao_rays(slots.ao, index, point, normal, outside);
        }
    }
    AT(args.pixels, index) = slots;
}
