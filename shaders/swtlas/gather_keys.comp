// SPDX-License-Identifier: MIT
// Gathers keys for sorting leaves once more, in their present order.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/build.h"
layout(local_size_x = BUILD_GROUP) in;
layout(push_constant, scalar) uniform Push { GatherKeysArgs args; };

void main()
{
    uint i = global_index();
    if (i >= args.count) return;
    AT(args.keys, i) = AT(args.values, AT(args.order, i));
}
