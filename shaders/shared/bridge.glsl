// SPDX-License-Identifier: MIT
// The GLSL side of the bridge: gives shared headers the words that both languages understand.
// Its C++ twin is engine/core/shader_bridge.h; no shared header contains a language #ifdef.
#ifndef TWINRAY_BRIDGE_GLSL
#define TWINRAY_BRIDGE_GLSL
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_control_flow_attributes : require

#extension GL_EXT_spirv_intrinsics : require

// The lesser and the greater of two numbers, and of a number and NaN the number: what min() and max() leave open. Of two
// zeros either.
spirv_instruction(set = "GLSL.std.450", id = 79) float min_number(float a, float b);
spirv_instruction(set = "GLSL.std.450", id = 80) float max_number(float a, float b);

// Whether fma() rounds once. Set for every kernel that the library makes (DeviceFacts::fused_fma).
layout(constant_id = 105) const bool FUSED_FMA = false;
#define FUSED(a, b, c) fma(a, b, c)

#define FUNC
#define INOUT(T) inout T
#define PRECISE precise
#define REF(T) T##_ref
#define AT(ref, i) ref.items[i]
#define BUFFER_OF(T, alignment) \
    layout(buffer_reference, scalar, buffer_reference_align = alignment) buffer T##_ref { T items[]; }
#define BUFFER_OF_WORDS(name, T, alignment) \
    layout(buffer_reference, scalar, buffer_reference_align = alignment) buffer name { T items[]; }
#define FEATURE(id, name) layout(constant_id = id) const bool name = true;

// The two numbers that lie in one 64-bit word, the low one first. That one by way of the upper half: where a vector holds a word
// in two places, drivers on CPUs take five operations for the lower halves.
uvec2 uints_of(uint64_t word) { return uvec2(unpackUint2x32(word << 32u).y, unpackUint2x32(word).y); }
#define FLOATS(word) uintBitsToFloat(uints_of(word))
#define UINTS(word) uints_of(word)
#define WORD(low, high) packUint2x32(uvec2(low, high))
// For where either rounding will do.
#define FMA(a, b, c) fma(a, b, c)
#define UNROLL [[unroll]]
#define DONT_UNROLL [[dont_unroll]]

BUFFER_OF_WORDS(Words64, uint64_t, 8);
BUFFER_OF_WORDS(Floats, float, 4);
BUFFER_OF_WORDS(Uints, uint, 4);
BUFFER_OF_WORDS(Vec4s, vec4, 4);

// Linear index of this group and this invocation; Kernel::dispatch spreads large counts over x and y. Macros, because
// gl_WorkGroupSize has its value only after the shader's local_size declaration, which follows this include.
#define group_index() (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x)
#define global_index() (group_index() * gl_WorkGroupSize.x + gl_LocalInvocationID.x)
// The same after dealing groups out to `hands` (shaders/shared/workgroup.h), for kernels whose groups take unequal times.
#define dealt_index(hands) (dealt_group(group_index(), gl_NumWorkGroups.x * gl_NumWorkGroups.y, hands) * gl_WorkGroupSize.x + gl_LocalInvocationID.x)
#endif
