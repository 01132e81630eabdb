// SPDX-License-Identifier: MIT
// The arguments and results of the kernel spawn.comp; read by C++ and GLSL.
#ifndef TWINRAY_SUITE_SPAWN_ARGS_H
#define TWINRAY_SUITE_SPAWN_ARGS_H

// A ray that must leave a point of a triangle.
struct SpawnItem {
    vec3 direction;
    uint primitive;
    vec2 uv;
    uint instance;
    uint reserved;
};
BUFFER_OF(SpawnItem, 8);

struct SpawnPrice {
    float offset;  // of the point, see SurfacePoint
    float feature;
};
BUFFER_OF(SpawnPrice, 8);

// The method that keeps it from hitting its own triangle. The rays of method m begin at m * count.
const uint SPAWN_BOUND = 0u;    // twinray/glsl/spawn.glsl
const uint SPAWN_NONE = 1u;     // not at all
const uint SPAWN_T_MIN = 2u;    // t_min = 1e-4
const uint SPAWN_INTEGER = 3u;  // Waechter and Binder, Ray Tracing Gems, chapter 6, 2019: integers added to the bits
const uint SPAWN_METHODS = 4u;

struct SpawnArgs {
    REF(SpawnItem) items;
    REF(InstanceRecord) instances;
    Floats positions;
    Uints indices;
    REF(Ray) rays;           // written
    REF(SpawnPrice) prices;  // written
    uint count;
    uint reserved;
};
#endif
