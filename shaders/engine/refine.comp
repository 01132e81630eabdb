// SPDX-License-Identifier: MIT
// Gathers the data of each instance that refining needs; computes t, u and v of hits in float64, of rays in float64.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TWINRAY_REFINED
#include "twinray/glsl/common.glsl"
#include "shaders/shared/exact_hit.h"

#ifdef KERNEL_REFINE_GATHER
layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push { RefineGatherArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    AT(args.instances, i) = refine_instance(in_built_units(AT(args.records, i)), absent_near(args.records.address));
}
#endif

#ifdef KERNEL_EXACT_HITS
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ExactHitsArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    Hit hit = AT(args.hits, i);
    if (hit.hit == 0u) return;
    AT(args.results, i) = exact_hit(AT(args.scene, 0).instances, AT(args.rays, i), hit);
}
#endif
