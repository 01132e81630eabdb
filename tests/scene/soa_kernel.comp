// Shifts all items of a queue, and accesses some that do not exist.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/soa.glsl"
#include "tests/scene/set_kernel.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SoaTestArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.invocations) return;
    vec3 origin = vec3(FALLBACK);
    uint pixel = 77u;
    float t = FALLBACK;
    Diffuse material = Diffuse(vec3(FALLBACK), FALLBACK);
    SOA_GET(args.from, i + args.shift, origin, origin)
    SOA_GET(args.from, i + args.shift, pixel, pixel)
    SOA_GET(args.from, i + args.shift, t, t)
    SOA_GET(args.from, i + args.shift, material, material)
    SOA_SET(args.to, i, origin, origin + vec3(1.0))
    SOA_SET(args.to, i, pixel, pixel)
    SOA_SET(args.to, i, t, 2.0 * t)
    SOA_SET(args.to, i, material, material)
}
