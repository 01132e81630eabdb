// SPDX-License-Identifier: MIT
// Copies transforms from the caller's device memory into instance records; ids, masks and flags stay.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/copy_transforms.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CopyTransformsArgs args; };

void main()
{
    uint index = global_index();
    if (index >= args.count) return;
    AT(args.records, index).object_to_world =
        Rows(AT(args.rows, 3u * index), AT(args.rows, 3u * index + 1u), AT(args.rows, 3u * index + 2u));
}
