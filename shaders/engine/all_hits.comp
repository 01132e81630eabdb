// SPDX-License-Identifier: MIT
// Every triangle is offered as if its instance were non-opaque, listed and refused, so that nothing ends the ray.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TWINRAY_PROGRAM
#include "twinray/glsl/query.glsl"
#include "shaders/shared/all_hits.h"
#include "shaders/engine/list.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { AllHitsArgs args; };

bool intersect_primitive(Candidate candidate, Ray ray_local, inout float t, inout vec2 uv) { return false; }

// Filters of users may not write (see program.h): this kernel asks how often it is called.
bool accept_hit(Candidate candidate, float t, vec2 uv) {
    uint slot = append_to(args.total);
    if (slot >= args.capacity) return false;
    Hit hit;
    hit.hit = 1u;
    hit.t = t;
    hit.primitive_index = candidate.primitive_index;
    hit.custom_index = candidate.custom_index;
    hit.u = uv.x;
    hit.v = uv.y;
    hit.instance_index = candidate.instance_index;
    hit.flags = candidate.is_front ? HIT_FRONT : 0u;
    AT(args.found, slot).ray = args.first + global_index();
    AT(args.found, slot).hit = hit;
    return false;
}

void main() {
    uint i = args.first + global_index();
    if (i >= args.end) return;
    uint flags = args.flags | ALL_NON_OPAQUE;
    trace(args.scene, AT(args.rays, i), trace_options(args.mask, flags, QUERY_CLOSEST, absent_near(args.scene)));
}
