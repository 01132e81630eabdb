// SPDX-License-Identifier: MIT
// Copies from the caller's device memory, of which only the address is known.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/copies.h"
layout(local_size_x = 64) in;

#ifdef KERNEL_COPY_WORDS
layout(push_constant, scalar) uniform Push { CopyWordsArgs args; };

void main() {
    uint index = global_index();
    if (index < args.count) AT(args.to, index) = AT(args.from, index);
}
#endif

#ifdef KERNEL_COPY_FLOATS
layout(push_constant, scalar) uniform Push { CopyFloatsArgs args; };

void main() {
    uint index = global_index();
    if (index < args.count) AT(args.to, index) = AT(args.from, index) * args.factor;
}
#endif

#ifdef KERNEL_COPY_TRANSFORMS
layout(push_constant, scalar) uniform Push { CopyTransformsArgs args; };

void main() {
    uint index = global_index();
    if (index >= args.count) return;
    AT(args.records, index).object_to_world =
        Rows(AT(args.rows, 3u * index), AT(args.rows, 3u * index + 1u), AT(args.rows, 3u * index + 2u));
}
#endif
