// SPDX-License-Identifier: MIT
// The rays of a tile, one an invocation, and the answers, four an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/spawn.h"
#include "shaders/analysis/visible.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { VisibleArgs args; };

#ifdef KERNEL_VISIBLE_RAYS
vec3 row(Floats numbers, uint index) {
    return vec3(AT(numbers, 3u * index), AT(numbers, 3u * index + 1u), AT(numbers, 3u * index + 2u));
}

// Returns a point of a surface, moved off along the normal as far as rounding may have moved the surface, as
// SurfacePoint::offset of a triangle that is not known.
vec3 clear_of_surface(vec3 point, vec3 normal) {
    vec3 unit = normal / scaled_length(normal);
    vec3 error = abs(point) * INVERSE_ERROR + vec3(args.reach * (TEST_ERROR + INVERSE_ERROR));
    return point + unit * dot(error, abs(unit));
}

void main() {
    uint i = global_index();
    if (i >= args.ray_count) return;
    uint point = args.first_point + i / args.vector_count;
    Ray ray;
    ray.origin = row(args.points, point);
    ray.t_min = args.t_near;
    ray.direction = row(args.vectors, i % args.vector_count);
    ray.t_max = args.t_far;
    if (!is_absent(args.normals)) {
        vec3 normal = row(args.normals, point);
        ray.origin = clear_of_surface(ray.origin, normal);
        if (!(dot(normal, ray.direction) > 0.0f)) ray.t_max = -1.0f;
    }
    AT(args.rays, i) = ray;
}
#endif

#ifdef KERNEL_VISIBLE_ANSWERS
void main() {
    uint word = global_index();
    if (word >= (args.ray_count + 3u) / 4u) return;
    uint bytes = 0u;
    for (uint k = 0u; k < 4u; ++k) {
        uint i = 4u * word + k;
        if (i < args.ray_count && AT(args.rays, i).t_max > 0.0f && AT(args.hits, i).hit == 0u) bytes |= 1u << 8u * k;
    }
    AT(args.answers, word) = bytes;
}
#endif
