// SPDX-License-Identifier: MIT
// The materials of the sample, for C++ and GLSL alike.
#ifndef TWINRAY_SAMPLES_MATERIALS_H
#define TWINRAY_SAMPLES_MATERIALS_H
#include "twinray/glsl/multi_type_set.h"
#include "twinray/glsl/textures.h"

struct Checker {
    vec3 even;
    vec3 odd;
    float cells;  // along a side
};
BUFFER_OF(Checker, 4);

struct Painted {
    TextureRef texture;
    float gain;
};
BUFFER_OF(Painted, 4);

#define MATERIALS(X, P) X(P, 0, Checker, checker) X(P, 1, Painted, painted)
TWINRAY_SET_VIEW(MaterialSet, MATERIALS)

struct SwatchArgs {
    MaterialSet materials;
    TextureTable textures;
    REF(SetKey) keys;  // by swatch
    Uints picture;     // 8-bit RGBA, swatches side by side
    uint swatches;
    uint side;  // of a swatch, in pixels
};
#endif
