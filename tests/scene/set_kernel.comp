// Looks elements of sets up by key, and runs unrolled loops over the types of one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/multi_type_set.glsl"
#include "twinray/glsl/unrolled.glsl"
#include "tests/scene/set_kernel.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SetTestArgs args; };

TUPLE(TestTuple, TEST_TYPES)
struct Values {
    float diffuse;
    float glass;
    float layered;
};
float value_with_2(Diffuse diffuse) { return value_of(diffuse, 2.0); }
float value_with_2(Glass glass) { return value_of(glass, 2.0); }
float value_with_2(Layered layered) { return value_of(layered, 2.0); }
float joined(float sum, Diffuse diffuse) { return 10.0 * sum + value_of(diffuse, 2.0); }
float joined(float sum, Glass glass) { return 10.0 * sum + value_of(glass, 2.0); }
float joined(float sum, Layered layered) { return 10.0 * sum + value_of(layered, 2.0); }

void run_unrolled(Floats results) {
    TestTuple tuple = TestTuple(AT(args.set.diffuse, 0), AT(args.set.glass, 0), AT(args.set.layered, 0));
    float folded = 0.0;
#define FOLD(element) folded = 3.0 * folded + value_of(element, 1.0)
    FOR_UNROLLED(TEST_TYPES, tuple, FOLD)
    AT(results, 0) = folded;
    Values values;
    MAP_UNROLLED(TEST_TYPES, tuple, values, value_with_2)
    AT(results, 1) = values.diffuse;
    AT(results, 2) = values.glass;
    AT(results, 3) = values.layered;
    float reduced = 1.0;
    REDUCE_UNROLLED(TEST_TYPES, tuple, reduced, joined)
    AT(results, 4) = reduced;
    float sum = 0.0;
    SUM_UNROLLED(TEST_TYPES, tuple, sum, value_with_2)
    AT(results, 5) = sum;
    for (int i = 0; i < 3; i++) {
        float picked = FALLBACK;
#define PICK(element) picked = value_of(element, 4.0)
        GET_UNROLLED(TEST_TYPES, tuple, 2 * i - 1, PICK)  // -1, 1, 3: one of them is there
        AT(results, 6 + i) = picked;
    }
}

void main() {
    uint i = global_index();
    if (args.writes != 0u) {
        if (i < args.set.glass_count) AT(args.set.glass, i).ior = 2.0 * AT(args.set.glass, i).ior;
        return;
    }
    if (i < args.count) {
        SetKey key = AT(args.keys, i);
        float value = FALLBACK;
#define VALUE_OF(element) value = value_of(element, float(i))
        WITH_INDEX(TEST_TYPES, args.set, key, VALUE_OF)
        AT(args.values, i) = value;
    }
    if (i != 0u) return;
    float sum = 0.0;
#define ADD(element, n) sum += weight_of(n) * value_of(element, 1.0)
    FOREACH_ELEMENT(TEST_TYPES, args.set, ADD)
    AT(args.values, args.count) = sum;
    if (args.set.diffuse_count != 0u && args.set.glass_count != 0u && args.set.layered_count != 0u)
        run_unrolled(Floats(address_at(args.values.address, args.count + 1u, 4u)));
}
