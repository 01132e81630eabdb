// SPDX-License-Identifier: MIT
// Notes the rays on which two accelerators name different hits. For any hit only hit or miss is compared: which hit
// is found first is theirs to choose.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/rays.h"
#include "twinray/glsl/soa.h"
#include "shaders/path_tracer/scene.h"
#include "shaders/path_tracer/wave.h"
layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { CompareArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    Hit first = AT(args.first, i);
    Hit second = AT(args.second, i);
    bool is_same = first.hit == second.hit;
    if (args.is_any == 0u)
        is_same =
            is_same && first.instance_index == second.instance_index && first.primitive_index == second.primitive_index;
    if (is_same) return;
    uint pixel = AT(args.pixels, i);
    AT(args.marks, pixel) = 1u;
    uint slot = atomicAdd(AT(args.found_count, 0), 1u);
    if (slot >= args.capacity) return;
    Disagreement found;
    found.ray = AT(args.rays, i);
    found.first = first;
    found.second = second;
    found.pixel = pixel;
    found.is_any = args.is_any;
    AT(args.found, slot) = found;
}
