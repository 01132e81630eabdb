// SPDX-License-Identifier: MIT
// Makes rays that leave points of triangles, by twinray/glsl/spawn.glsl or by another method for comparison.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/spawn.glsl"
#include "shaders/suite/spawn_args.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SpawnArgs args; };

// Moves by 256 units in the last place along the normal for large coordinates, by a length near 0, where units are
// small.
float moved(float coordinate, float normal) {
    if (abs(coordinate) < 1.0 / 32.0) return coordinate + normal / 65536.0;
    int steps = int(256.0 * normal);
    return intBitsToFloat(floatBitsToInt(coordinate) + (coordinate < 0.0 ? -steps : steps));
}

vec3 start_of(SurfacePoint point, uint method, bool is_front) {
    if (method == SPAWN_BOUND) return spawn_position(point, is_front);
    if (method != SPAWN_INTEGER) return point.position;
    vec3 normal = is_front ? point.normal : -point.normal;
    return vec3(moved(point.position.x, normal.x), moved(point.position.y, normal.y),
                moved(point.position.z, normal.z));
}

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    SpawnItem item = AT(args.items, i);
    Placement placement = placement_of(AT(args.instances, item.instance));
    SurfacePoint point = surface_point(placement, vertices_of(args.positions, args.indices, item.primitive), item.uv);
    for (uint method = 0u; method < SPAWN_METHODS; ++method) {
        Ray ray;
        ray.origin = start_of(point, method, dot(item.direction, point.normal) > 0.0);
        ray.t_min = method == SPAWN_T_MIN ? 1e-4 : 0.0;
        ray.direction = item.direction;
        ray.t_max = uintBitsToFloat(0x7f800000u);
        AT(args.rays, method * args.count + i) = ray;
    }
    AT(args.prices, i).offset = point.offset;
    AT(args.prices, i).feature = point.feature;
}
