// SPDX-License-Identifier: MIT
// The names and records by which kernels reach textures, from TextureStore.
#ifndef TWINRAY_GLSL_TEXTURES_H
#define TWINRAY_GLSL_TEXTURES_H
#include "twinray/glsl/faults.h"

// Names one texture as long as its store lives. All zero: none.
struct TextureRef {
    uint number;  // its place in the store + 1
};
BUFFER_OF(TextureRef, 4);

const uint TEXTURE_REPEAT = 0u;
const uint TEXTURE_CLAMP = 1u;
const uint TEXTURE_MIRROR = 2u;

// The values of TexelFormat.
const uint TEXEL_UNORM8 = 0u;
const uint TEXEL_UNORM16 = 1u;
const uint TEXEL_FLOAT16 = 2u;
const uint TEXEL_FLOAT32 = 3u;

// A specialisation constant of kernels for all textures of a store that are in buffers: whether some have formats or
// channels other than four of unorm8. True, its default, reads any.
const uint TEXEL_FORMATS_CONSTANT = 107u;

// A texture in a buffer.
struct TextureRecord {
    Uints texels;  // row 0 at v = 0; a level begins at a multiple of 4 bytes
    uint width;
    uint height;
    uint wraps;    // TEXTURE_* for u, and times 4 for v
    uint options;  // 1: sRGB; 2: not filtered; 4: not filtered between levels
    uint format;   // TEXEL_*, and the number of channels times 4
    uint levels;
};
BUFFER_OF(TextureRecord, 8);

// All textures of a store; `records` is absent if they are images, which kernels reach through descriptors.
struct TextureTable {
    REF(TextureRecord) records;
    uint count;
    uint reserved;
    REF(Faults) faults;
    Uint64 revision;
};
#endif
