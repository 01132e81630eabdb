// Finds up to `most` hits of each ray, one after the other.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/next_hit.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
    Address accel;
    REF(Ray) rays;
    REF(Hit) hits;  // `most` for each ray
    uint count;
    uint most;
}
push;

void main() {
    uint i = global_index();
    if (i >= push.count) return;
    Hit hit = no_hit();
    for (uint k = 0u; k < push.most; k++) {
        bool is_found = next_hit(push.accel, AT(push.rays, i), hit);
        AT(push.hits, i * push.most + k) = hit;
        if (!is_found) break;
    }
}
