// SPDX-License-Identifier: MIT
// What the page on sets shows, as its later blocks take it for given, for C++ and GLSL alike.
#ifndef TWINRAY_TESTS_DOCS_MATERIALS_H
#define TWINRAY_TESTS_DOCS_MATERIALS_H
#include "twinray/glsl/multi_type_set.h"
#include "twinray/glsl/soa.h"
#include "twinray/glsl/textures.h"

struct Checker {
    vec3 even;
    vec3 odd;
    float cells;
};
BUFFER_OF(Checker, 4);
struct Painted {
    TextureRef texture;
    float gain;
};
BUFFER_OF(Painted, 4);
#define MATERIALS(X, P) X(P, 0, Checker, checker) X(P, 1, Painted, painted)
TWINRAY_SET_VIEW(MaterialSet, MATERIALS)
#define RAY_QUEUE(X, P) X(P, 0, vec3, origin) X(P, 1, vec3, direction) X(P, 2, uint, pixel)
TWINRAY_SOA_VIEW(RayQueue, RAY_QUEUE)

struct PaintArgs {
    MaterialSet materials;
    TextureTable textures;
};
#endif
