// SPDX-License-Identifier: MIT
// The C++ side of the bridge: what shaders/shared/*.h need to compile as C++ in namespace twinray.
// Include this, then open namespace twinray and include shared headers between
// engine/core/bridge_begin.h and engine/core/bridge_end.h.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

namespace twinray {

using uint = std::uint32_t;
using glm::abs;
using glm::ceil;
using glm::clamp;
using glm::cross;
using glm::dot;
using glm::dvec3;
using glm::dvec4;
using glm::floor;
using glm::ivec3;
using glm::max;
using glm::min;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using std::uint64_t;

constexpr bool FUSED_FMA = false;  // compilers of C++ may, but need not fuse

// Of a number and NaN the number.
inline float min_number(float a, float b) { return a < b || b != b ? a : b; }
inline float max_number(float a, float b) { return a > b || b != b ? a : b; }

inline float uintBitsToFloat(uint bits) { return std::bit_cast<float>(bits); }
inline uint floatBitsToUint(float value) { return std::bit_cast<uint>(value); }

// Eight bytes: a device address when pushed to the GPU, a host address in the serial CPU twins.
template <class T>
struct Ref {
    std::uint64_t address = 0;

    T& operator[](std::size_t i) const { return reinterpret_cast<T*>(address)[i]; }
    explicit operator std::uint64_t() const { return address; }
    static Ref to(const T* host) { return {reinterpret_cast<std::uint64_t>(host)}; }
};

// The words of any structure, which others read and write as what they are.
struct Words64 {
    using Word [[gnu::may_alias]] = std::uint64_t;
    std::uint64_t address = 0;

    Word& operator[](std::size_t i) const { return reinterpret_cast<Word*>(address)[i]; }
    explicit operator std::uint64_t() const { return address; }
};

using Floats = Ref<float>;
using Uints = Ref<uint>;
using Vec4s = Ref<vec4>;

inline vec2 floats_of(std::uint64_t word) {
    return {uintBitsToFloat(static_cast<uint>(word)), uintBitsToFloat(static_cast<uint>(word >> 32))};
}
inline uvec2 uints_of(std::uint64_t word) { return {static_cast<uint>(word), static_cast<uint>(word >> 32)}; }
inline std::uint64_t word_of(uint low, uint high) { return std::uint64_t{high} << 32 | low; }

}  // namespace twinray
