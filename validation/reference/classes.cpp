// SPDX-License-Identifier: MIT
#include <twinray/validation.h>

#include <numeric>

#include "engine/core/statistics.h"

namespace twinray {
std::string_view name_of(HitClass kind) {
    static constexpr std::array<std::string_view, hit_class_count> names = {
        "AGREE",    "TIE",   "BOUNDARY", "BOUNDARY_HW_MISS", "UNSPECIFIED", "INVALID_INPUT", "SW_LEAK",
        "SW_FALSE", "T_ERR", "HW_LEAK",  "HW_FALSE",         "HW_T_ERR",    "HW_RANGE"};
    return names[static_cast<std::size_t>(kind)];
}

bool is_fault_of_hardware(HitClass kind) {
    return kind == HitClass::hw_leak || kind == HitClass::hw_false || kind == HitClass::hw_t_err ||
           kind == HitClass::hw_range;
}

bool is_fault_of_ours(HitClass kind) {
    return kind == HitClass::sw_leak || kind == HitClass::sw_false || kind == HitClass::t_err;
}

HitClassCounts& HitClassCounts::operator+=(const HitClassCounts& other) {
    for (std::size_t i = 0; i < hit_class_count; ++i) counts[i] += other.counts[i];
    return *this;
}

std::uint64_t HitClassCounts::total() const { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); }

std::uint64_t HitClassCounts::faults_of_ours() const {
    return (*this)[HitClass::sw_leak] + (*this)[HitClass::sw_false] + (*this)[HitClass::t_err];
}

std::uint64_t HitClassCounts::faults_of_hardware() const {
    return (*this)[HitClass::hw_leak] + (*this)[HitClass::hw_false] + (*this)[HitClass::hw_t_err] +
           (*this)[HitClass::hw_range];
}

double HitClassCounts::bound_95() const { return upper_bound_95(faults_of_ours() + faults_of_hardware(), total()); }

HitClassCounts count(std::span<const HitClass> classes) {
    HitClassCounts counts;
    for (const HitClass kind : classes) counts.add(kind);
    return counts;
}

}  // namespace twinray
