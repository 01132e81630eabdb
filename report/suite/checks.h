// The figures of a record, computed from answers; nothing here runs on a device.
#pragma once

#include "report/suite/suite.h"
#include "validation/cpu_reference/reference_scene.h"
#include "validation/reference/classify.h"

namespace twinray::suite {

// Returns the reference's answers to all rays, on all cores, with t of the triangle's plane in long double.
std::vector<ReferenceHit> references_of(const ReferenceScene& reference, std::span<const Ray> rays);

// Returns |t - reference| in units of the reference's last place in float32, or nothing unless the hit names the
// reference's primitive.
std::optional<double> t_ulps(const ReferenceHit& reference, const Hit& hit);

// Takes at least one error; all must be 0 or more. The usual floor is half a unit in the last place of float32, in
// which view factors are kept.
ErrorFigures error_figures(const std::string& metric, std::vector<double> errors, double floor = 0x1p-25);

// Returns the figures of t_ulps, or nothing without any. The floor is the half unit of rounding t itself.
std::optional<ErrorFigures> t_error(std::span<const ReferenceHit> references, std::span<const Hit> hits);

bool same_bits(const Hit& a, const Hit& b);

// The quality of one accelerator's answers.
struct CheckResult {
    HitClassCounts classes;
    std::uint64_t faults = 0;                     // of twinray or of the driver; includes hits of invalid rays
    std::string example;                          // see Record::example
    std::optional<std::size_t> first_fault = {};  // its ray

    CheckResult& operator+=(const CheckResult& other);  // the other has its own rays
};
CheckResult check(const ReferenceScene& reference, std::span<const Ray> rays, std::span<const Hit> hits,
                  Backend backend);

// Writes counts, faults, bound and example to `record`.
void set_check_result(Record& record, const CheckResult& checked);

// ---- SwTlas's own code run on the CPU, to compare a device with it bit for bit.

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
