// SPDX-License-Identifier: MIT
// Copies between device addresses whose buffers are unknown.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/copies.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CopyItemsArgs args; };

void main() {
    uint item = global_index();
    if (item >= args.count) return;
    // 2^32 rays have more words than 32 bits can count.
    Uints from = Uints(address_at(args.from.address, item, args.words_per_item * 4u));
    Uints to = Uints(address_at(args.to.address, item, args.words_per_item * 4u));
    for (uint word = 0u; word < args.words_per_item; word = word + 1u) AT(to, word) = AT(from, word);
}
