// SPDX-License-Identifier: MIT
// Gathers the data of each instance that refining needs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/refine_scene.h"
layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push { RefineGatherArgs args; };

void main()
{
    uint i = global_index();
    if (i >= args.count) return;
    AT(args.instances, i) = refine_instance(in_built_units(AT(args.records, i)), absent_near(args.records.address));
}
