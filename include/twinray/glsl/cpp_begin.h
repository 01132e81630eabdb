// SPDX-License-Identifier: MIT
// Defines the vocabulary of headers written for C++ and GLSL; cpp_end.h undefines it. It has no include guard on
// purpose.
#define FUNC inline
#define TWINRAY_REFINED
#define INOUT(T) T&
#define PRECISE
#define REF(T) Ref<T>
#define AT(ref, i) ref[i]
#define BUFFER_OF(T, alignment) static_assert(sizeof(T) % (alignment) == 0)
#define FMA(a, b, c) ((a) * (b) + (c))
#define FUSED(a, b, c) std::fma(a, b, c)
#define COUNT_STEPS(what, count) traversal_steps().what += (count)
#define UNROLL
#define DONT_UNROLL
