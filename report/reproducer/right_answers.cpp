// SPDX-License-Identifier: MIT
#include "report/reproducer/right_answers.h"

#include <algorithm>
#include <cmath>
#include <iomanip>

#include "engine/core/error.h"
#include "validation/exact/exact_reference.h"
#include "validation/reference/error_bounds.h"
#include "validation/reference/point_distance.h"

namespace twinray::reproducer {
namespace {

// Sets the range in which u and v name points within point_error of the ray: all numbers if the ray sees the triangle
// edge-on.
void set_barycentrics(RightHit& right, const TriangleBound& bound) {
    const dvec2 a = bound.vertices[1] - bound.vertices[0], b = bound.vertices[2] - bound.vertices[0],
                ray = -bound.vertices[0];
    const double area = cross2(a, b);
    right.u = right.v = {-unlimited, unlimited};
    const auto around = [](double value, double error) { return Interval{value - error, value + error}; };
    if (area == 0) return;
    right.u = around(cross2(ray, b) / area, bound.point_error * std::hypot(b.x, b.y) / std::abs(area));
    right.v = around(cross2(a, ray) / area, bound.point_error * std::hypot(a.x, a.y) / std::abs(area));
}

double middle(const Interval& i) { return std::isfinite(i.high - i.low) ? i.low + (i.high - i.low) / 2 : 0; }

bool is_right(const ReferenceScene& reference, const Ray& ray, const Hit& hit) {
    return !is_fault_of_hardware(class_of(reference, ray, hit));
}

// Returns the number in decimal, and as a short fraction if it has one.
std::string words_of(const exact::Rational& value) {
    const std::string fraction = value.get_str(), decimal = text(std::setprecision(17), exact::rounded(value));
    constexpr std::size_t most_digits = 20;
    return fraction.size() <= most_digits && fraction != decimal ? text(fraction, " = ", decimal) : decimal;
}

std::string words_of(const std::optional<exact::ClosestHit>& closest) {
    if (!closest) return "a miss";
    const char* where[] = {"inside it", "on its edge", "at its vertex"};
    const exact::Crossing& crossing = closest->crossing;
    std::string words =
        text("triangle ", closest->triangles[0].primitive, " of instance ", closest->triangles[0].instance,
             " at t = ", words_of(crossing.t), ", u = ", words_of(crossing.u), ", v = ", words_of(crossing.v), ", ",
             where[static_cast<std::size_t>(crossing.incidence)]);
    if (closest->triangles.size() > 1) words += text("; ", closest->triangles.size(), " triangles meet the ray there");
    return words;
}

}  // namespace

HitClass class_of(const ReferenceScene& reference, const Ray& ray, const Hit& hit) {
    const exact::Reference exactly(reference);
    return *classify(reference, ray, {}, hit, [&](const Ray& r) { return exactly.rounded_hit(r); }).hardware;
}

bool RightHit::allows(const Hit& hit) const {
    return instance == hit.instance_index && primitive == hit.primitive_index && t.holds(hit.t) && u.holds(hit.u) &&
           v.holds(hit.v);
}

bool RightAnswers::allow(const Hit& hit) const {
    if (!hit.hit) return is_miss_right;
    return std::ranges::any_of(hits, [&](const RightHit& right) { return right.allows(hit); });
}

std::optional<RightHit> right_hit(const ReferenceScene& reference, const Ray& ray, uint instance, uint primitive) {
    const ErrorBounds bounds(ray, reference.placement(instance), Accelerator::hardware);
    const TriangleBound bound = bounds.bound(reference.geometry(instance).find(primitive)->vertices64());
    if (bound.margin < -bound.radius) return {};
    RightHit right{instance, primitive, {bound.t_low, bound.t_high}, {}, {}};
    set_barycentrics(right, bound);
    const float t = static_cast<float>(std::clamp(bound.t, bound.t_low, bound.t_high));
    const float u = static_cast<float>(middle(right.u)), v = static_cast<float>(middle(right.v));
    if (!is_right(reference, ray, {1, t, primitive, 0, u, v, instance, 0})) return {};
    return right;
}

RightAnswers right_answers(const ReferenceScene& reference, const Ray& ray) {
    RightAnswers right;
    right.exact = words_of(exact::Reference(reference).closest_hit(ray));
    right.is_miss_right = is_right(reference, ray, miss());
    for (uint instance = 0; instance < reference.instance_count(); ++instance)
        for (const ActiveTriangle& triangle : reference.geometry(instance).active())
            if (const auto hit = right_hit(reference, ray, instance, triangle.primitive)) right.hits.push_back(*hit);
    return right;
}

}  // namespace twinray::reproducer
