// SPDX-License-Identifier: MIT
#include "engine/verify/classes.h"

#include <numeric>

namespace twinray {
std::string_view name(Class kind) {
    static constexpr std::array<std::string_view, class_count> names = {
        "AGREE",    "TIE",   "BOUNDARY", "BOUNDARY_HW_MISS", "UNSPECIFIED", "INVALID_INPUT", "SW_LEAK",
        "SW_FALSE", "T_ERR", "HW_LEAK",  "HW_FALSE",         "HW_T_ERR",    "HW_RANGE"};
    return names[static_cast<std::size_t>(kind)];
}

bool is_fault_of_hardware(Class kind) {
    return kind == Class::hw_leak || kind == Class::hw_false || kind == Class::hw_t_err || kind == Class::hw_range;
}

bool is_fault_of_ours(Class kind) { return kind == Class::sw_leak || kind == Class::sw_false || kind == Class::t_err; }

Classes& Classes::operator+=(const Classes& other) {
    for (std::size_t i = 0; i < class_count; ++i) counts[i] += other.counts[i];
    return *this;
}

std::uint64_t Classes::total() const { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); }

std::uint64_t Classes::faults_of_ours() const {
    return (*this)[Class::sw_leak] + (*this)[Class::sw_false] + (*this)[Class::t_err];
}

std::uint64_t Classes::faults_of_hardware() const {
    return (*this)[Class::hw_leak] + (*this)[Class::hw_false] + (*this)[Class::hw_t_err] + (*this)[Class::hw_range];
}

}  // namespace twinray
