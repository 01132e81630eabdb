// Arguments of texture_kernel.comp.
#ifndef TWINRAY_TESTS_TEXTURE_KERNEL_H
#define TWINRAY_TESTS_TEXTURE_KERNEL_H
#include "twinray/glsl/textures.h"

// Asks for the size and one texel, and samples at a point.
struct TextureQuestion {
    TextureRef texture;
    int x;
    int y;
    vec2 uv;
    float lod;
};
BUFFER_OF(TextureQuestion, 4);

struct TextureAnswer {
    uvec2 size;
    vec4 texel;
    vec4 color;
    vec4 lod_color;
    uint levels;
};
BUFFER_OF(TextureAnswer, 4);

struct TextureTestArgs {
    TextureTable textures;
    REF(TextureQuestion) questions;
    REF(TextureAnswer) answers;
    uint count;
};
#endif
