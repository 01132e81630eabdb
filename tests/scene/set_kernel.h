// Types of the test's sets, and the functions called on them, alike on host and GPU.
#ifndef TWINRAY_TESTS_SET_KERNEL_H
#define TWINRAY_TESTS_SET_KERNEL_H
#include "twinray/glsl/multi_type_set.h"
#include "twinray/glsl/soa.h"

struct Diffuse {
    vec3 color;
    float gain;
};
BUFFER_OF(Diffuse, 4);

struct Glass {
    float ior;
};
BUFFER_OF(Glass, 4);

// A type longer than the others.
struct Layered {
    uvec2 id;
    vec4 lowest;
    vec4 middle;
    vec4 highest;
};
BUFFER_OF(Layered, 8);

#define TEST_TYPES(X, P) X(P, 0, Diffuse, diffuse) X(P, 1, Glass, glass) X(P, 2, Layered, layered)
TWINRAY_SET_VIEW(TestSet, TEST_TYPES)

FUNC float value_of(Diffuse diffuse, float x) { return x * diffuse.gain + diffuse.color.y; }
FUNC float value_of(Glass glass, float x) { return x - glass.ior; }
FUNC float value_of(Layered layered, float x) { return x + layered.highest.w + float(layered.id.y); }

// Returns the weight with which FOREACH_ELEMENT takes an element.
FUNC float weight_of(uint i) { return float(1u + i % 7u); }

#define TEST_QUEUE(X, P) X(P, 0, vec3, origin) X(P, 1, uint, pixel) X(P, 2, float, t) X(P, 3, Diffuse, material)
TWINRAY_SOA_VIEW(TestQueue, TEST_QUEUE)

struct SetTestArgs {
    TestSet set;
    REF(SetKey) keys;
    Floats values;  // by key, then the weighted sum of all elements, then results of the unrolled loops
    uint count;     // keys
    uint writes;    // whether elements of glass are doubled instead
};

struct SoaTestArgs {
    TestQueue from;
    TestQueue to;
    uint invocations;
    uint shift;  // item i + shift goes to item i
};

const float FALLBACK = -1000.0f;
const uint UNROLLED_RESULTS = 9u;
#endif
