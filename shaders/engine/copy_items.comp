// SPDX-License-Identifier: MIT
// Copies between device addresses whose buffers are not known.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bridge.glsl"
#include "shaders/shared/copy_items.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CopyItemsArgs args; };

void main()
{
    uint item = global_index();
    if (item >= args.count) return;
    // 64-bit: 2^32 rays have more words than 32 bits count.
    uint64_t offset = uint64_t(item) * args.words_per_item * 4ul;
    Uints from = Uints(uint64_t(args.from) + offset);
    Uints to = Uints(uint64_t(args.to) + offset);
    for (uint word = 0u; word < args.words_per_item; word = word + 1u) AT(to, word) = AT(from, word);
}
