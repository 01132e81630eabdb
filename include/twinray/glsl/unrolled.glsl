// SPDX-License-Identifier: MIT
// Loops over structs whose members differ in type, unrolled by the preprocessor: twinray/sets.h for kernels.
// FUNCTION is a set of overloads, ACTION a macro of the caller that may use the variables around it:
//
//     #define LIGHTS(X, P) X(P, 0, Lamp, lamp) X(P, 1, Sun, sun)
//     TUPLE(Lights, LIGHTS) // struct Lights { Lamp lamp; Sun sun; };
//     float power(Lamp lamp) { ... }
//     float power(Sun sun) { ... }
//
//     float total = 0.0;
//     SUM_UNROLLED(LIGHTS, lights, total, power)
//
// `tuple` is a variable or a member, not a call. For loops of a constant count, put UNROLL before `for`.
#ifndef TWINRAY_UNROLLED_GLSL
#define TWINRAY_UNROLLED_GLSL
#include "twinray/glsl/common.glsl"

#define TUPLE_FIELD_(P, number, Type, name) Type name;
// Declares struct Name with a member for each type of the list.
#define TUPLE(Name, LIST)     \
    struct Name {             \
        LIST(TUPLE_FIELD_, 0) \
    };

// The arguments that lists pass on to each type.
#define FIRST_(a, b, c) a
#define SECOND_(a, b, c) b
#define THIRD_(a, b, c) c

#define FOR_CASE_(P, number, Type, name) SECOND_ P(FIRST_ P.name);
// Runs ACTION(element) for each element, in order.
#define FOR_UNROLLED(LIST, tuple, ACTION) \
    { LIST(FOR_CASE_, (tuple, ACTION, 0)) }

#define MAP_CASE_(P, number, Type, name) SECOND_ P.name = THIRD_ P(FIRST_ P.name);
// to.member = FUNCTION(from.member) for each; `to` has members of the same names.
#define MAP_UNROLLED(LIST, from, to, FUNCTION) \
    { LIST(MAP_CASE_, (from, to, FUNCTION)) }

#define REDUCE_CASE_(P, number, Type, name) SECOND_ P = THIRD_ P(SECOND_ P, FIRST_ P.name);
// result = FUNCTION(result, element) for each in order; result keeps its value if there are none.
#define REDUCE_UNROLLED(LIST, tuple, result, FUNCTION) \
    { LIST(REDUCE_CASE_, (tuple, result, FUNCTION)) }

#define SUM_CASE_(P, number, Type, name) SECOND_ P = SECOND_ P + THIRD_ P(FIRST_ P.name);
// result = result + FUNCTION(element) for each in order.
#define SUM_UNROLLED(LIST, tuple, result, FUNCTION) \
    { LIST(SUM_CASE_, (tuple, result, FUNCTION)) }

#define GET_CASE_(P, number, Type, name) \
    case uint(number): SECOND_ P(FIRST_ P.name); break;
// Runs ACTION(element) for the element at an index, by a switch. An index out of range calls nothing.
#define GET_UNROLLED(LIST, tuple, index, ACTION) \
    switch (uint(index)) { LIST(GET_CASE_, (tuple, ACTION, 0)) default : break; }
#endif
