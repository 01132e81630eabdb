// SPDX-License-Identifier: MIT
// Hits in float64 of rays in float64.
#ifndef TWINRAY_SHARED_EXACT_HIT_H
#define TWINRAY_SHARED_EXACT_HIT_H
#include "shaders/shared/refine.h"
#include "twinray/glsl/ray64.h"

struct HitDouble {
    double t;
    double u;
    double v;
};
BUFFER_OF(HitDouble, 8);

struct ExactHitsArgs {
    REF(RefineScene) scene;
    REF(Ray64) rays;
    REF(Hit) hits;
    REF(HitDouble) results;  // of hits alone
    uint count;
    uint reserved;
};

// Returns the float64 result for the triangle that a hit names; the hit's own if the triangle's plane contains the ray.
FUNC HitDouble exact_hit(REF(RefineInstance) instances, Ray64 ray, Hit hit) {
    HitDouble exact;
    exact.t = double(hit.t);
    exact.u = double(hit.u);
    exact.v = double(hit.v);
    InstancedMesh placed = AT(instances, hit.instance_index).placed;
    if (is_absent(placed.mesh.indices)) return exact;
    PlaneHit met = meet_plane(ray.origin, ray.direction, placed, hit.primitive_index);
    if (met.det == double(0.0f)) return exact;
    exact.t = met.t;
    exact.u = met.u;
    exact.v = met.v;
    return exact;
}
#endif
