// A kernel as a user writes it: its own closest and any hits.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/query.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
    Address accel;
    REF(Ray) rays;
    REF(Hit) hits;
    Uints blocked;
    uint count;
    uint mask;
}
push;

void main() {
    uint i = global_index();
    if (i >= push.count) return;
    Ray ray = AT(push.rays, i);
    Hit hit;
    bool is_hit = push.mask == 0xffu ? closest_hit(push.accel, ray, hit)
                                     : closest_hit(push.accel, ray, push.mask, CULL_BACK, hit);
    if (is_hit != (hit.hit == 1u)) hit.flags = 0x100u;
    Hit any;
    uint flags = push.mask == 0xffu ? 0u : CULL_BACK;
    bool has_any = any_hit(push.accel, ray, push.mask, flags, any);
    if (has_any != (any.hit == 1u) || has_any != is_hit || (has_any && any.t < hit.t)) hit.flags = 0x200u;
    AT(push.hits, i) = hit;
    AT(push.blocked, i) = any_hit(push.accel, ray, push.mask, push.mask == 0xffu ? 0u : CULL_BACK) ? 1u : 0u;
}
