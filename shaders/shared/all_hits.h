// SPDX-License-Identifier: MIT
// All hits of a ray, not only the closest.
#ifndef TWINRAY_SHARED_ALL_HITS_H
#define TWINRAY_SHARED_ALL_HITS_H
#include "shaders/shared/list.h"
#include "twinray/glsl/rays.h"

struct RayHit {
    uint ray;
    Hit hit;
};
BUFFER_OF(RayHit, 4);

struct AllHitsArgs {
    Address scene;  // AccelView::scene
    REF(Ray) rays;
    REF(RayHit) found;  // written, with room for `capacity`; hardware may list a hit more than once
    REF(ListTotal) total;
    uint first;  // ray of this dispatch
    uint end;    // of its rays
    uint capacity;
    uint mask;
    uint flags;
    uint reserved;
};
#endif
