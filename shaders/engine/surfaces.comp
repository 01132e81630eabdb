// SPDX-License-Identifier: MIT
// The surface of each hit, or an attribute there, for hosts.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/surface_args.h"
layout(local_size_x = 64) in;

#ifdef KERNEL_SURFACES
layout(push_constant, scalar) uniform Push { SurfaceArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    Hit hit = AT(args.hits, i);
    Surface surface = no_surface();
    if (hit.hit != 0u && surface_geometry(AT(args.table, 0), hit.instance_index).face_count != 0u)
        surface = surface_at(surface_place(AT(args.table, 0), AT(args.rays, i), hit), hit.instance_index);
    AT(REF(Surface)(args.results), i) = surface;
}
#endif

#ifdef KERNEL_INTERPOLATE
layout(push_constant, scalar) uniform Push { InterpolateArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.of.count) return;
    Hit hit = AT(args.of.hits, i);
    vec4 value = args.missing;
    if (hit.hit != 0u && surface_geometry(AT(args.of.table, 0), hit.instance_index).face_count != 0u)
        value = attribute_at(surface_place(AT(args.of.table, 0), AT(args.of.rays, i), hit), args.number, value);
    AT(Vec4s(args.of.results), i) = value;
}
#endif
