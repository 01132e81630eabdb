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
using glm::umulExtended;
using glm::uvec2;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

constexpr bool FUSED_FMA = false;  // compilers of C++ may, but need not fuse

// Of NaN and a number b it is b.
inline float min_no_nan(float a, float b) { return a < b ? a : b; }
inline float max_no_nan(float a, float b) { return a > b ? a : b; }

inline float uintBitsToFloat(uint bits) { return std::bit_cast<float>(bits); }
inline uint floatBitsToUint(float value) { return std::bit_cast<uint>(value); }

// Eight bytes: a device address when pushed to the GPU, a host address in CPU references. GLSL has two words for
// them, so that structs are to be aligned as there.
using Address [[gnu::aligned(4)]] = std::uint64_t;
using Uint64 [[gnu::aligned(4)]] = std::uint64_t;

constexpr std::uint64_t NULL_ADDRESS = 0;
inline bool is_null(std::uint64_t address) { return address == NULL_ADDRESS; }
inline std::uint64_t address_after(std::uint64_t base, uint bytes) { return base + bytes; }
inline std::uint64_t address_at(std::uint64_t base, uint index, uint stride) {
    return base + std::uint64_t{index} * stride;
}

template <class T>
struct Ref {
    Address address = 0;

    T& operator[](std::size_t i) const { return reinterpret_cast<T*>(address)[i]; }
    static Ref to(const T* host) { return {reinterpret_cast<std::uint64_t>(host)}; }
};
template <class T>
bool is_null(Ref<T> ref) {
    return is_null(ref.address);
}

using Floats = Ref<float>;
using Uints = Ref<uint>;
using Vec2s = Ref<vec2>;
using Vec3s = Ref<vec3>;
using Vec4s = Ref<vec4>;
using Uvec2s = Ref<uvec2>;
using Uvec3s = Ref<uvec3>;

#include "engine/core/bridge_begin.h"
#include "shaders/shared/word64.h"
#include "engine/core/bridge_end.h"

}  // namespace twinray
