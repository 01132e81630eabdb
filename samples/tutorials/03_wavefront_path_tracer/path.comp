// SPDX-License-Identifier: MIT
// Each invocation traces one path from the camera to its end.
// [kernel]
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/query.glsl"
#include "twinray/glsl/surface.glsl"
#include "twinray/glsl/spawn.glsl"
#include "path.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PathArgs args; };

vec3 radiance(Path path) {
    Ray ray = camera_ray(AT(args.room, 0).eye, path, args.job.width, args.job.height);
    Lamp lamp = AT(args.room, 0).lamp;
    vec3 sum = vec3(0.0);
    Hit hit;
    while (closest_hit(args.accel, ray, hit)) {
        SurfacePoint point = point_at(surface_place(args.accel, ray, hit));
        Scattering found = scatter(path, ray, point, AT(args.room, 0).looks[hit.custom_index], lamp);
        sum += found.seen;
        bool asks_lamp = found.lamp.light != vec3(0.0);
        if (asks_lamp && !any_hit(args.accel, found.lamp.shadow, SOLID_MASK, 0u)) sum += found.lamp.light;
        if (found.goes_on == 0u) break;
        ray = found.next;
    }
    return sum;
}

void main() {
    uint i = global_index(), pixels = args.job.width * args.job.height;
    if (i >= pixels * args.job.samples) return;
    AT(args.radiances, i) = radiance(begin_path(i % pixels, args.job.first_sample + i / pixels));
}
