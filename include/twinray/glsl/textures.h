// SPDX-License-Identifier: MIT
// Textures as kernels name and reach them: what TextureStore gives.
#ifndef TWINRAY_GLSL_TEXTURES_H
#define TWINRAY_GLSL_TEXTURES_H
#include "twinray/glsl/faults.h"

// Names one texture, for as long as its store lives. All zero: none.
struct TextureRef {
    uint number;  // its place in the store + 1
};
BUFFER_OF(TextureRef, 4);

const uint TEXTURE_REPEAT = 0u;
const uint TEXTURE_CLAMP = 1u;
const uint TEXTURE_MIRROR = 2u;

// A texture in a buffer.
struct TextureRecord {
    Uints texels;  // 8-bit RGBA, row 0 at v = 0
    uint width;
    uint height;
    uint wrap_u;  // TEXTURE_*
    uint wrap_v;
    uint is_srgb;
    uint is_nearest;  // not filtered
};
BUFFER_OF(TextureRecord, 8);

// All textures of a store; `records` is null where they are images, which kernels reach through descriptors.
struct TextureTable {
    REF(TextureRecord) records;
    uint count;
    uint reserved;
    REF(Faults) faults;
    Uint64 revision;
};
#endif
