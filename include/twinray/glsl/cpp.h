// SPDX-License-Identifier: MIT
// Definitions that C++ needs to compile headers written for both languages, those of twinray and of an application's
// kernels: structs of arguments and of buffers, and functions that the host also runs. Include this, then such headers
// in namespace twinray between twinray/glsl/cpp_begin.h and twinray/glsl/cpp_end.h. Needs GLM.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "twinray/glsl/vector_math.h"

namespace twinray {

constexpr bool FUSED_FMA = false;  // C++ compilers may fuse but need not

// They return b if a is NaN.
inline float min_no_nan(float a, float b) { return a < b ? a : b; }
inline float max_no_nan(float a, float b) { return a > b ? a : b; }

inline float uintBitsToFloat(uint bits) { return std::bit_cast<float>(bits); }
inline uint floatBitsToUint(float value) { return std::bit_cast<uint>(value); }

constexpr std::uint64_t NULL_ADDRESS = 0;
// On the host, 0 also means absent; kernels get Context::absent instead.
inline bool is_absent(std::uint64_t address) { return address == NULL_ADDRESS || (address & 1) != 0; }
inline std::uint64_t absent_near(std::uint64_t present) { return present | 1; }
inline std::uint64_t address_after(std::uint64_t base, uint bytes) { return base + bytes; }
inline std::uint64_t address_at(std::uint64_t base, uint index, uint stride) {
    return base + std::uint64_t{index} * stride;
}

template <class T>
bool is_absent(Ref<T> ref) {
    return is_absent(ref.address);
}

using Vec2s = Ref<vec2>;
using Vec3s = Ref<vec3>;
using Vec4s = Ref<vec4>;
using Uvec2s = Ref<uvec2>;
using Uvec3s = Ref<uvec3>;

}  // namespace twinray
