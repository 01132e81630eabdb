// SPDX-License-Identifier: MIT
#include "report/suite/cpu_reference.h"

#include <algorithm>
#include <cstring>

#include "validation/cpu_reference/flush_denormals.h"
#include "report/suite/checks.h"
#include "engine/core/parallel.h"

namespace twinray::suite {
namespace {

bool is_same_decision(const Hit& a, const Hit& b) {
    return a.hit == b.hit && a.instance_index == b.instance_index && a.primitive_index == b.primitive_index;
}

// Returns the steps from one float to the other; both are positive or 0.
double ulps_between(float a, float b) {
    return std::abs(double(std::bit_cast<std::int32_t>(a)) - double(std::bit_cast<std::int32_t>(b)));
}

}  // namespace

std::vector<Hit> trace_cpu_reference(const reference::Scene& on_cpu, std::span<const Ray> rays, Level level,
                                     Denormals denormals) {
    std::vector<Hit> hits(rays.size());
    parallel_for(rays.size(), [&](std::size_t begin, std::size_t end) {
        std::optional<FlushDenormals> flush;
        if (denormals == Denormals::flushed) flush.emplace();
        for (std::size_t i = begin; i < end; ++i)
            hits[i] = on_cpu.trace(rays[i], QUERY_CLOSEST, 0xff, static_cast<uint>(level));
    });
    return hits;
}

Difference& Difference::operator+=(const Difference& other) {
    decisions += other.decisions;
    bits += other.bits;
    worst_ulp = std::max(worst_ulp, other.worst_ulp);
    if (example.empty()) example = other.example;
    return *this;
}

Difference difference(std::span<const Ray> rays, std::span<const Hit> hits, std::span<const Hit> on_cpu) {
    Difference result;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (std::memcmp(&hits[i], &on_cpu[i], sizeof(Hit)) == 0) continue;
        if (result.total() == 0) result.example = hexadecimal(rays[i]);
        if (!is_same_decision(hits[i], on_cpu[i])) {
            ++result.decisions;
            continue;
        }
        ++result.bits;
        result.worst_ulp = std::max(result.worst_ulp, ulps_between(hits[i].t, on_cpu[i].t));
    }
    return result;
}

}  // namespace twinray::suite
