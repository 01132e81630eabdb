// SPDX-License-Identifier: MIT
// Counts how often each ray crosses the triangles of a scene whose instances are all non-opaque: every hit is offered,
// counted and refused, so that nothing ends the ray. A closest hit would hide that an edge is hit twice.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TWINRAY_PROGRAM
#include "twinray/glsl/query.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
    Address scene;  // AccelView::scene
    REF(Ray) rays;
    Uints counts;  // written
    uint count;
}
push;

uint crossings = 0u;  // of this invocation's ray

#ifdef TWINRAY_HW
// A driver may offer the same triangle more than once, which is no second crossing. The kernel distinguishes as many
// crossings as fit here.
uvec2 met[16];

bool is_met_again(Candidate candidate) {
    uvec2 name = uvec2(candidate.instance_index, candidate.primitive_index);
    for (uint i = 0u; i < min(crossings, 16u); i++)
        if (met[i] == name) return true;
    if (crossings < 16u) met[crossings] = name;
    return false;
}
#else
bool is_met_again(Candidate candidate) { return false; }  // SwTlas meets a triangle once, or is wrong
#endif

bool intersect_primitive(Candidate candidate, Ray ray_local, inout float t, inout vec2 uv) { return false; }

// Filters must not write (see program.h): this kernel counts the calls.
bool accept_hit(Candidate candidate, float t, vec2 uv) {
    if (!is_met_again(candidate)) crossings++;
    return false;
}

void main() {
    uint i = global_index();
    if (i >= push.count) return;
    trace(push.scene, AT(push.rays, i), trace_options(0xffu, 0u, QUERY_CLOSEST, absent_near(push.scene)));
    AT(push.counts, i) = crossings;
}
