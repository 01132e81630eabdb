// SPDX-License-Identifier: MIT
// SwTlas's own code run on the CPU, to compare a device with it bit for bit.
#pragma once

#include "report/suite/tracing.h"
#include "validation/cpu_reference/reference_scene.h"

namespace twinray::suite {

using reference::cpu_reference_of;

enum class Denormals : std::uint8_t { kept, flushed };  // flushed needs FlushDenormals::is_able()

// Returns the closest hits of all rays, on all cores.
std::vector<Hit> trace_cpu_reference(const reference::Scene& on_cpu, std::span<const Ray> rays, Level level,
                                     Denormals denormals = Denormals::kept);

// How a device's hits differ from the CPU reference's.
struct Difference {
    std::uint64_t decisions = 0;  // hit or miss, instance, primitive
    std::uint64_t bits = 0;       // the same decision, but t, u, v or another field is not the same to the last bit
    double worst_ulp = 0;         // of t, if the decision is the same
    std::string example;          // the first ray that differs, see hexadecimal()

    Difference& operator+=(const Difference& other);
    std::uint64_t total() const { return decisions + bits; }
};
Difference difference(std::span<const Ray> rays, std::span<const Hit> hits, std::span<const Hit> on_cpu);

}  // namespace twinray::suite
