// SPDX-License-Identifier: MIT
// Definitions that GLSL needs to compile headers written for both languages; twinray/glsl/cpp.h is the same for C++.
// Include it first.
#ifndef TWINRAY_COMMON_GLSL
#define TWINRAY_COMMON_GLSL
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_control_flow_attributes : require

#extension GL_EXT_spirv_intrinsics : require

// Returns NMin: the lesser of two numbers; if one is NaN, the other.
spirv_instruction(set = "GLSL.std.450", id = 79) float n_min(float a, float b);
// Returns NMax: the greater of two numbers; if one is NaN, the other.
spirv_instruction(set = "GLSL.std.450", id = 80) float n_max(float a, float b);
// True if min_no_nan() and max_no_nan() use comparisons, because that costs less than NMin and NMax
// (KernelTuning::compares_numbers).
layout(constant_id = 106) const bool COMPARES_NUMBERS = false;
// Returns the lesser of two numbers; b if a is NaN, which min() leaves open. It may be either of two zeros.
float min_no_nan(float a, float b) { return COMPARES_NUMBERS ? (a < b ? a : b) : n_min(a, b); }
// Returns the greater of two numbers; b if a is NaN, which max() leaves open. It may be either of two zeros.
float max_no_nan(float a, float b) { return COMPARES_NUMBERS ? (a > b ? a : b) : n_max(a, b); }

// True if fma() rounds once. It is set for every kernel that the library makes (KernelTuning::has_fused_fma).
layout(constant_id = 105) const bool FUSED_FMA = false;
// a * b + c, rounded once if FUSED_FMA is true.
#define FUSED(a, b, c) fma(a, b, c)

#define FUNC
// The type of a parameter that the function reads and writes; in C++ a reference.
#define INOUT(T) inout T
// Put before a variable: its expression is computed as written, not fused or reordered.
#define PRECISE precise

// An address in device memory, and other 64-bit integers that kernels pass on. It consists of two words, the low one
// first, because not every device has 64-bit integers.
#define Address uvec2
// A 64-bit integer that is no address, likewise in two words.
#define Uint64 uvec2
const Address NULL_ADDRESS = Address(0u);
// Kernels get no unreadable address, because a driver may read through it before it knows that the branch around the
// read is not taken. Absent data has an odd address (Context::absent); all other addresses are multiples of 4.
bool is_absent(Address address) { return (address.x & 1u) != 0u; }
// Returns the address of something absent, derived from that of anything present.
Address absent_near(Address present) { return Address(present.x | 1u, present.y); }
// Returns the address `bytes` bytes after `base`.
Address address_after(Address base, uint bytes) {
    uint carry;
    uint low = uaddCarry(base.x, bytes, carry);
    return Address(low, base.y + carry);
}
// Returns the address of item `index` in an array of items of `stride` bytes.
Address address_at(Address base, uint index, uint stride) {
    uint high, low;
    umulExtended(index, stride, high, low);
    return address_after(base, low) + Address(0u, high);
}

// REF(T) is the address of items of type T. It is a struct of its own so that functions can overload by it. It becomes
// a pointer only in AT: some drivers cannot compile pointers in structs and variables.
#define REFERENCE(name, qualifier, contents, alignment)                                                                \
    layout(buffer_reference, scalar, buffer_reference_align = alignment) qualifier buffer name##_buffer { contents; }; \
    struct name {                                                                                                      \
        Address address;                                                                                               \
    };                                                                                                                 \
    name##_buffer buffer_of(name ref) { return name##_buffer(ref.address); }                                           \
    bool is_absent(name ref) { return is_absent(ref.address); }
// The type of the address of items of type T, which BUFFER_OF declares.
#define REF(T) T##_ref
// Item i at an address; it can be read and written.
#define AT(ref, i) buffer_of(ref).items[i]
// Declares REF(T) for a struct T; `alignment` is that of the addresses, in bytes.
#define BUFFER_OF(T, alignment) REFERENCE(T##_ref, , T items[], alignment)
// Declares a specialisation constant that says whether kernels have a feature; all have it unless told otherwise.
#define FEATURE(id, name) layout(constant_id = id) const bool name = true;

// a * b + c in code that is correct with either rounding.
#define FMA(a, b, c) fma(a, b, c)
// Counts work of a traversal in its CPU reference; does nothing in kernels.
#define COUNT_STEPS(what, count)
// Put before `for`: unrolls the loop.
#define UNROLL [[unroll]]
// Put before `for`: keeps the loop if its body is long.
#define DONT_UNROLL [[dont_unroll]]

REFERENCE(Floats, , float items[], 4)
REFERENCE(Uints, , uint items[], 4)
REFERENCE(Vec2s, , vec2 items[], 4)
REFERENCE(Vec3s, , vec3 items[], 4)
REFERENCE(Vec4s, , vec4 items[], 4)
REFERENCE(Uvec2s, , uvec2 items[], 4)
REFERENCE(Uvec3s, , uvec3 items[], 4)

// Linear index of this group; Kernel::dispatch spreads large counts over x and y. It is a macro, like the next two,
// because gl_WorkGroupSize has its value only after the shader's local_size declaration, which follows this include.
#define group_index() (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x)
// Linear index of this invocation, from 0, which is its item of the dispatch.
#define global_index() (group_index() * gl_WorkGroupSize.x + gl_LocalInvocationID.x)
// The same after dealing groups out to `threads` (shaders/shared/workgroup.h), for kernels whose groups take unequal
// times.
#define interleaved_index(threads)                                                                             \
    (interleaved_group(group_index(), gl_NumWorkGroups.x * gl_NumWorkGroups.y, threads) * gl_WorkGroupSize.x + \
     gl_LocalInvocationID.x)
#endif
