// SPDX-License-Identifier: MIT
// The kinds of agreement and disagreement between an accelerator and the referee, and counting them.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace twinray {

// What an accelerator's answer to one ray is worth.
enum class Class : std::uint8_t {
    agree,             // same hit or miss as the referee, t within its error bound
    tie,               // another primitive at the same t, within both error bounds
    boundary,          // rounding decides: a silhouette, a rim, a triangle that the ray passes within rounding
    boundary_hw_miss,  // the same, and hardware missed
    unspecified,       // Vulkan promises nothing: T-junction, or t at t_min, t_max or beyond float32
    invalid_input,     // hit reported for a ray that is not is_traceable()
    sw_leak,           // missed a hit that no rounding of the ray excuses, wholly or for one farther away
    sw_false,          // reported a triangle that the ray misses by more than rounding, or a t outside the interval
    t_err,             // SW reported the right triangle at a t, u or v beyond the error bound
    hw_leak,
    hw_false,
    hw_t_err,
    hw_range,  // not finite t, u or v, or u, v beyond the error bound: over- or underflow in the driver
};
inline constexpr std::size_t class_count = 13;

// "AGREE", "SW_LEAK", "T_ERR", ... as in reports.
std::string_view name(Class kind);

// sw_leak, sw_false and t_err: their count must be 0.
bool is_fault_of_ours(Class kind);
// hw_leak, hw_false, hw_t_err and hw_range.
bool is_fault_of_hardware(Class kind);

// How often each class occurred.
struct Classes {
    std::array<std::uint64_t, class_count> counts{};

    std::uint64_t operator[](Class kind) const { return counts[static_cast<std::size_t>(kind)]; }
    void add(Class kind) { ++counts[static_cast<std::size_t>(kind)]; }
    Classes& operator+=(const Classes& other);
    std::uint64_t total() const;
    std::uint64_t faults_of_ours() const;      // sw_leak, sw_false, t_err
    std::uint64_t faults_of_hardware() const;  // hw_leak, hw_false, hw_t_err, hw_range
};

}  // namespace twinray
