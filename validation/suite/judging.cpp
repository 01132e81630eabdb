// SPDX-License-Identifier: MIT
#include "validation/suite/judging.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "engine/core/parallel.h"

namespace twinray::suite {
namespace {

double ulp_of(double value) {
    const auto rounded = static_cast<float>(std::abs(value));
    if (!std::isfinite(rounded)) return std::numeric_limits<double>::infinity();
    return static_cast<double>(std::nextafter(rounded, std::numeric_limits<float>::infinity())) - double{rounded};
}

bool is_fault(Class kind) {
    return is_fault_of_ours(kind) || is_fault_of_hardware(kind) || kind == Class::invalid_input;
}

using Vector = Vec<3, long double>;

// t of the triangle's plane, from its corners in world space. The oracle's t is a mean of the corners' depths, which
// loses 3 units in the last place of float32 where these are 1e10 times as far as the hit; here it keeps 2^-64.
std::optional<double> t_of_plane(const Oracle& oracle, const Ray& ray, const OracleHit& hit) {
    const Placement64& placement = oracle.placement(hit.instance);
    std::array<Vector, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector corner(oracle.geometry(hit.instance).find(hit.primitive)->corners[i]);
        corners[i] =
            glm::mat<3, 3, long double>(placement.to_world) * corner + Vector(placement.offset) - Vector(ray.origin);
    }
    const Vector normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const Vector& nearest = *std::min_element(corners.begin(), corners.end(),
                                              [](const Vector& a, const Vector& b) { return dot(a, a) < dot(b, b); });
    const long double t = dot(normal, nearest) / dot(normal, Vector(ray.direction));
    return std::isfinite(t) ? std::optional(static_cast<double>(t)) : std::nullopt;
}

}  // namespace

std::vector<OracleHit> references_of(const Oracle& oracle, std::span<const Ray> rays) {
    std::vector<OracleHit> references(rays.size());
    parallel_for(rays.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            references[i] = oracle.closest_hit(rays[i]);
            if (references[i].hit)
                references[i].t = t_of_plane(oracle, rays[i], references[i]).value_or(references[i].t);
        }
    });
    return references;
}

std::optional<double> t_ulps(const OracleHit& reference, const Hit& hit) {
    const bool is_same = hit.hit && reference.hit && hit.instance_index == reference.instance &&
                         hit.primitive_index == reference.primitive;
    if (!is_same) return std::nullopt;
    return std::abs(double{hit.t} - reference.t) / ulp_of(reference.t);
}

std::optional<ErrorFigures> t_error(std::span<const OracleHit> references, std::span<const Hit> hits) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < hits.size(); ++i)
        if (const auto ulps = t_ulps(references[i], hits[i])) errors.push_back(*ulps);
    if (errors.empty()) return std::nullopt;
    std::sort(errors.begin(), errors.end());
    return ErrorFigures{
        "t_ulp", quantile(errors, 0.5), quantile(errors, 0.99), quantile_interval_95(errors, 0.99), errors.back(), 0.5};
}

Judgement judge(const Oracle& oracle, std::span<const Ray> rays, std::span<const Hit> hits, Backend backend) {
    const std::vector<Verdict> verdicts =
        is_ours(backend) ? classify_all(oracle, rays, hits, {}) : classify_all(oracle, rays, {}, hits);
    Judgement judgement;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Class kind = is_ours(backend) ? *verdicts[i].software : *verdicts[i].hardware;
        judgement.classes.add(kind);
        if (!is_fault(kind)) continue;
        if (judgement.faults++ > 0) continue;
        judgement.example = std::string(name(kind)) + ' ' + hexadecimal(rays[i]);
        judgement.first_fault = i;
    }
    return judgement;
}

void set_judgement(Record& record, const Judgement& judgement) {
    record.n = judgement.classes.total();
    record.faults = judgement.faults;
    record.bound95 = upper_bound_95(record.faults, record.n);
    record.example = judgement.example;
    for (std::size_t kind = 0; kind < class_count; ++kind)
        if (const std::uint64_t count = judgement.classes.counts[kind])
            record.counts[std::string(name(static_cast<Class>(kind)))] = count;
}

std::string hexadecimal(const Ray& ray) {
    std::ostringstream out;
    out << std::hexfloat;
    for (const float value : {ray.origin.x, ray.origin.y, ray.origin.z, ray.t_min, ray.direction.x, ray.direction.y,
                              ray.direction.z, ray.t_max})
        out << (out.tellp() > 0 ? " " : "") << value;
    return out.str();
}

}  // namespace twinray::suite
