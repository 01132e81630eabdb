// SPDX-License-Identifier: MIT
// What the page on sets shows, as its later blocks take it for given, for C++ and GLSL alike: the sample's materials, a
// queue and arguments of a kernel.
#ifndef TWINRAY_TESTS_DOCS_MATERIALS_H
#define TWINRAY_TESTS_DOCS_MATERIALS_H
#include "twinray/glsl/soa.h"

#include "samples/materials.h"

#define RAY_QUEUE(X, P) X(P, 0, vec3, origin) X(P, 1, vec3, direction) X(P, 2, uint, pixel)
TWINRAY_SOA_VIEW(RayQueue, RAY_QUEUE)

struct PaintArgs {
    MaterialSet materials;
    TextureTable textures;
};
#endif
