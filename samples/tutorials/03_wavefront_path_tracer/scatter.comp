// SPDX-License-Identifier: MIT
// Each invocation computes one bounce of a path. The next rays go to queues.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/surface.glsl"
#include "twinray/glsl/spawn.glsl"
#include "path.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { WaveArgs args; };

// [scatter]
void push(DeviceQueue queue, Ray ray, Path path) {
    uint slot = atomicAdd(AT(queue.count, 0), 1u);
    AT(queue.rays, slot) = ray;
    AT(queue.paths, slot) = path;
}

void main() {
    uint i = global_index();
    if (i >= AT(args.queue.count, 0) || AT(args.hits, i).hit == 0u) return;
    Hit hit = AT(args.hits, i);
    Ray ray = AT(args.queue.rays, i);
    Path path = AT(args.queue.paths, i);
    SurfacePoint point = point_at(surface_place(args.accel, ray, hit));
    Look look = AT(args.room, 0).looks[hit.custom_index];
    Scattering found = scatter(path, ray, point, look, AT(args.room, 0).lamp);
    AT(args.radiances, place_of(args, path)) += found.seen;
    if (found.goes_on != 0u) push(args.next, found.next, path);
    if (found.lamp.light == vec3(0.0)) return;
    path.weight = found.lamp.light;
    push(args.shadows, found.lamp.shadow, path);
}
