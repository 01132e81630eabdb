// SPDX-License-Identifier: MIT
// Structures of arrays, such as wavefront queues: the struct in which kernels take one.
//
// A list of fields has the form of a list of types (multi_type_set.h):
//     #define RAY_QUEUE(X, P) X(P, 0, vec3, origin) X(P, 1, vec3, direction) X(P, 2, float, t_max)
#ifndef TWINRAY_GLSL_SOA_H
#define TWINRAY_GLSL_SOA_H
#include "twinray/glsl/faults.h"

// Arrays of plain words and vectors; for structs, BUFFER_OF is next to the struct.
BUFFER_OF(float, 4);
BUFFER_OF(uint, 4);
BUFFER_OF(vec2, 4);
BUFFER_OF(vec3, 4);
BUFFER_OF(vec4, 4);
BUFFER_OF(uvec2, 4);

// A field's part of TWINRAY_SOA_VIEW.
#define TWINRAY_SOA_FIELD(P, number, Type, name) REF(Type) name;
// TWINRAY_SOA_VIEW(RayQueue, RAY_QUEUE) declares struct RayQueue with an array for each field and the `count` of items
// in all of them. It has 8 bytes per field and 16 more.
#define TWINRAY_SOA_VIEW(Name, LIST)           \
    struct Name {                              \
        LIST(TWINRAY_SOA_FIELD, 0) uint count; \
        uint reserved;                         \
        REF(Faults) faults;                    \
    };
#endif
