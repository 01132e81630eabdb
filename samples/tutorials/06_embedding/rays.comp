// SPDX-License-Identifier: MIT
// Makes the rays of each pixel: one to the sun, then those to the nearby sky.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/random.h"
#include "twinray/glsl/sampling.h"
#include "twinray/glsl/spawn.glsl"
#include "scene.glsl"
layout(local_size_x = 8, local_size_y = 8) in;

const float EVERYWHERE = 1e30, NEAR_BY = 1.5;  // t_max

// [point]
// The point that the pixel shows, and the distance at which rays must start so that they do not hit its own triangle.
SurfacePoint point_of(Seen seen) {
    Placement placement = placement_of(Rows(seen.body.to_world[0], seen.body.to_world[1], seen.body.to_world[2]));
    TriangleVertices corners = TriangleVertices(seen.a.position, seen.b.position, seen.c.position);
    return surface_point(placement, corners, seen.uv);
}

Ray ray_from(SurfacePoint point, vec3 direction, float t_max) {
    return Ray(spawn_position(point, dot(direction, point.normal) > 0.0), 0.0, direction, t_max);
}
// [/point]

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= args.width || pixel.y >= args.height) return;
    // [rays]
    uint index = pixel.y * args.width + pixel.x, first = index * args.rays_per_pixel;
    REF(Ray) rays = REF(Ray)(args.rays);
    Seen seen;
    if (!look(pixel, seen)) {
        for (uint i = 0u; i < args.rays_per_pixel; ++i)
            AT(rays, first + i) = Ray(vec3(0), 0.0, vec3(0), 0.0);  // misses
        return;
    }
    SurfacePoint point = point_of(seen);
    vec3 outside = dot(point.normal, seen.normal) > 0.0 ? point.normal : -point.normal;
    AT(rays, first) = ray_from(point, TO_SUN, EVERYWHERE);
    Frame about = frame_about(seen.normal);
    for (uint i = 1u; i < args.rays_per_pixel; ++i) {
        vec3 direction = to_world(about, sample_cosine_hemisphere(unit_floats(sample_pair(index, i - 1u, 0u, 1u))));
        direction -= min(2.0 * dot(direction, outside), 0.0) * outside;  // not through the triangle
        AT(rays, first + i) = ray_from(point, direction, NEAR_BY);
    }
    // [/rays]
}
