// SPDX-License-Identifier: MIT
// Keys of a set of elements of several types, and the struct in which kernels take the set.
//
// A list of types is a macro that names each of them once, for C++ and GLSL alike; numbers count from 0:
//     #define MATERIALS(X, P) X(P, 0, Diffuse, diffuse) X(P, 1, Glass, glass)
#ifndef TWINRAY_GLSL_MULTI_TYPE_SET_H
#define TWINRAY_GLSL_MULTI_TYPE_SET_H
#include "twinray/glsl/faults.h"

// Names one element of a set, for as long as the set lives. All zero: names none.
struct SetKey {
    uint type;   // its number in the list of types + 1
    uint index;  // among the elements of its type, from 0
};
BUFFER_OF(SetKey, 4);

// Returns whether it can name an element: it is not all zero.
FUNC bool is_valid(SetKey key) { return key.type != 0u; }

// A type's part of TWINRAY_SET_VIEW.
#define TWINRAY_SET_FIELD(P, number, Type, name) \
    REF(Type) name;                              \
    uint name##_count;                           \
    uint name##_reserved;
// TWINRAY_SET_VIEW(MaterialSet, MATERIALS) declares struct MaterialSet with, for each type, the array `diffuse` of its
// elements and their number `diffuse_count`. It has 16 bytes per type and 16 more. The element types need a BUFFER_OF
// before it.
#define TWINRAY_SET_VIEW(Name, LIST)                   \
    struct Name {                                      \
        LIST(TWINRAY_SET_FIELD, 0) REF(Faults) faults; \
        Uint64 revision;                               \
    };
#endif
