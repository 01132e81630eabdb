#include "report/suite/checks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "engine/core/parallel.h"
#include "validation/cpu_reference/flush_denormals.h"

namespace twinray::suite {
namespace {

double ulp_of(double value) {
    const auto rounded = static_cast<float>(std::abs(value));
    if (!std::isfinite(rounded)) return std::numeric_limits<double>::infinity();
    return static_cast<double>(std::nextafter(rounded, std::numeric_limits<float>::infinity())) - double{rounded};
}

bool is_fault(HitClass kind) {
    return is_fault_of_ours(kind) || is_fault_of_hardware(kind) || kind == HitClass::invalid_input;
}

using Vector = Vec<3, long double>;

// Returns t of the triangle's plane, from its vertices in world space. The reference's t is a mean of the vertices'
// depths, which loses 3 units in the last place of float32 if these are 1e10 times as far as the hit; this one keeps
// 2^-64.
std::optional<double> t_of_plane(const ReferenceScene& reference, const Ray& ray, const ReferenceHit& hit) {
    const Placement64& placement = reference.placement(hit.instance);
    std::array<Vector, 3> vertices;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector vertex(reference.geometry(hit.instance).find(hit.primitive)->vertices[i]);
        vertices[i] =
            glm::mat<3, 3, long double>(placement.to_world) * vertex + Vector(placement.offset) - Vector(ray.origin);
    }
    const Vector normal = cross(vertices[1] - vertices[0], vertices[2] - vertices[0]);
    const Vector& nearest = *std::ranges::min_element(vertices, {}, [](const Vector& v) { return dot(v, v); });
    const long double t = dot(normal, nearest) / dot(normal, Vector(ray.direction));
    return std::isfinite(t) ? std::optional(static_cast<double>(t)) : std::nullopt;
}

bool is_same_decision(const Hit& a, const Hit& b) {
    return a.hit == b.hit && a.instance_index == b.instance_index && a.primitive_index == b.primitive_index;
}

// Returns the steps from one float to the other; both are positive or 0.
double ulps_between(float a, float b) {
    return std::abs(double(std::bit_cast<std::int32_t>(a)) - double(std::bit_cast<std::int32_t>(b)));
}

}  // namespace

std::vector<ReferenceHit> references_of(const ReferenceScene& reference, std::span<const Ray> rays) {
    std::vector<ReferenceHit> references(rays.size());
    parallel_for(rays.size(), [&](std::size_t i) {
        references[i] = reference.closest_hit(rays[i]);
        if (references[i].hit)
            references[i].t = t_of_plane(reference, rays[i], references[i]).value_or(references[i].t);
    });
    return references;
}

std::optional<double> t_ulps(const ReferenceHit& reference, const Hit& hit) {
    const bool is_same = hit.hit && reference.hit && hit.instance_index == reference.instance &&
                         hit.primitive_index == reference.primitive;
    if (!is_same) return std::nullopt;
    return std::abs(double{hit.t} - reference.t) / ulp_of(reference.t);
}

ErrorFigures error_figures(const std::string& metric, std::vector<double> errors, double floor) {
    std::sort(errors.begin(), errors.end());
    return {metric, quantile(errors, 0.5), quantile(errors, 0.99), quantile_interval_95(errors, 0.99), errors.back(),
            floor};
}

std::optional<ErrorFigures> t_error(std::span<const ReferenceHit> references, std::span<const Hit> hits) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (const auto ulps = t_ulps(references[i], hits[i])) errors.push_back(*ulps);
    if (errors.empty()) return std::nullopt;
    return error_figures("t_ulp", std::move(errors), 0.5);
}

bool same_bits(const Hit& a, const Hit& b) { return std::memcmp(&a, &b, sizeof(Hit)) == 0; }

CheckResult& CheckResult::operator+=(const CheckResult& other) {
    classes += other.classes;
    faults += other.faults;
    if (example.empty()) example = other.example;
    return *this;
}

CheckResult check(const ReferenceScene& reference, std::span<const Ray> rays, std::span<const Hit> hits,
                  Backend backend) {
    const std::vector<RayResult> ray_results =
        is_ours(backend) ? classify_all(reference, rays, hits, {}) : classify_all(reference, rays, {}, hits);
    CheckResult checked;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const HitClass kind = is_ours(backend) ? *ray_results[i].software : *ray_results[i].hardware;
        checked.classes.add(kind);
        if (!is_fault(kind)) continue;
        if (checked.faults++ > 0) continue;
        checked.example = std::string(name_of(kind)) + ' ' + hexadecimal(rays[i]);
        checked.first_fault = i;
    }
    return checked;
}

void set_check_result(Record& record, const CheckResult& checked) {
    set_faults(record, checked.faults, checked.classes.total());
    record.example = checked.example;
    for (std::size_t kind = 0; kind < hit_class_count; ++kind)
        if (const std::uint64_t count = checked.classes.counts[kind])
            record.counts[std::string(name_of(static_cast<HitClass>(kind)))] = count;
}

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
        if (same_bits(hits[i], on_cpu[i])) continue;
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
