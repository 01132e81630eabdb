// SPDX-License-Identifier: MIT
// From answers to the figures of a record; nothing here runs on a device.
#pragma once

#include "validation/suite/suite.h"
#include "engine/verify/classify.h"

namespace twinray::suite {

// The referee's answers to all rays, on all cores, with t of the triangle's plane in long double.
std::vector<OracleHit> references_of(const Oracle& oracle, std::span<const Ray> rays);

// |t - reference| in units of the reference's last place in float32; nothing unless the hit names the referee's
// primitive.
std::optional<double> t_ulps(const OracleHit& reference, const Hit& hit);

// The figures of t_ulps; nothing where there is none. The floor is the half unit of rounding t itself.
std::optional<ErrorFigures> t_error(std::span<const OracleHit> references, std::span<const Hit> hits);

// What one accelerator's answers are worth.
struct Judgement {
    Classes classes;
    std::uint64_t faults = 0;  // of ours, or of the driver's; hits of rays that nobody may trace among them
    std::string example;       // see Record::example
    std::optional<std::size_t> first_fault = {};  // its ray
};
Judgement judge(const Oracle& oracle, std::span<const Ray> rays, std::span<const Hit> hits, Backend backend);

// Writes them to `record`: counts, faults, bound and example.
void set_judgement(Record& record, const Judgement& judgement);

// A ray as Record::example shows it.
std::string hexadecimal(const Ray& ray);

}  // namespace twinray::suite
