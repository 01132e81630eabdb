// Computes surfaces in a user's kernel, for a batch of hits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/surface.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
    Address accel;
    REF(Ray) rays;
    REF(Hit) hits;
    REF(Surface) surfaces;
    Vec4s others;  // two for each ray
    uint count;
    uint heat;
}
push;

void main() {
    uint i = global_index();
    if (i >= push.count) return;
    Hit hit = AT(push.hits, i);
    if (hit.hit == 0u) return;
    Ray ray = AT(push.rays, i);
    AT(push.surfaces, i) = surface_at(push.accel, ray, hit);
    vec4 heat = vec4(0.0);
    if (has_surface(push.accel, hit)) heat = attribute_at(surface_place(push.accel, ray, hit), push.heat, heat);
    AT(push.others, 2u * i) =
        vec4(heat.x, uintBitsToFloat(face_metadata(push.accel, hit)), uintBitsToFloat(index_in_handle(push.accel, hit)),
             uintBitsToFloat(handle_of(push.accel, hit).x));
    Address whole = geometry_metadata(push.accel, hit);
    AT(push.others, 2u * i + 1u).x = uintBitsToFloat(AT(Uints(whole), 1));
}
