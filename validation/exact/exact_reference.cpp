// SPDX-License-Identifier: MIT
#include "validation/exact/exact_reference.h"

#include <algorithm>

#include "validation/reference/error_bounds.h"

namespace twinray::exact {
namespace {

// The inverse of a placement's linear part, by cofactors.
struct Inverse {
    std::array<Vector, 3> rows;

    explicit Inverse(const Placement64& placement) {
        const Vector a = vector_of(placement.to_world[0]), b = vector_of(placement.to_world[1]),
                     c = vector_of(placement.to_world[2]);  // columns
        rows = {cross(b, c), cross(c, a), cross(a, b)};
        const Rational determinant = dot(a, rows[0]);
        for (Vector& row : rows) row = {row.x / determinant, row.y / determinant, row.z / determinant};
    }
    Vector operator*(const Vector& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
};

// The closest of all candidates in the ray's open interval.
struct Search {
    Rational t_min;
    std::optional<Rational> t_max;  // nothing: infinity
    std::optional<ClosestHit> best = {};
    double t_limit;  // not below the best t, or t_max

    explicit Search(const Ray& ray) : t_min(std::max(0.0, double{ray.t_min})), t_limit(ray.t_max) {
        if (std::isfinite(ray.t_max)) t_max = Rational(ray.t_max);
    }

    void offer(const Crossing& crossing, TriangleId triangle) {
        if (crossing.t <= t_min || (t_max && crossing.t >= *t_max)) return;
        if (best && crossing.t > best->crossing.t) return;
        if (best && crossing.t == best->crossing.t) {
            if (triangle < best->triangles.front()) best->crossing = crossing;
            best->triangles.insert(std::ranges::lower_bound(best->triangles, triangle), triangle);
            return;
        }
        best = {crossing, {triangle}};
        t_limit = std::min(t_limit, std::nextafter(rounded(crossing.t), INFINITY));
    }
};

}  // namespace

Line object_line(const Ray& ray, const Placement64& placement) {
    const Line line{vector_of(ray.origin), vector_of(ray.direction)};
    if (placement.is_identity) return line;
    const Inverse inverse(placement);
    return {inverse * (line.origin - vector_of(placement.offset)), inverse * line.direction};
}

std::optional<ClosestHit> Reference::closest_hit(const Ray& ray) const {
    if (!is_traceable(ray)) return std::nullopt;
    Search search(ray);
    for (const uint instance : reference_.instances_near(ray)) {
        const Geometry64& geometry = reference_.geometry(instance);
        const ErrorBounds bounds(ray, reference_.placement(instance), Accelerator::reference);
        const Line line = object_line(ray, reference_.placement(instance));
        geometry.visit(bounds.slabs(bounds.max_radius(geometry.bounds())), std::max(0.0, double{ray.t_min}),
                       search.t_limit, [&](const ActiveTriangle& triangle) {
                           if (const auto met = crossing(line, triangle.vertices64()))
                               search.offer(*met, {instance, triangle.primitive});
                           return true;
                       });
    }
    return search.best;
}

ReferenceHit Reference::rounded_hit(const Ray& ray) const { return to_float64(closest_hit(ray), reference_); }

std::optional<ClosestHit> Reference::closest_hit_brute_force(const Ray& ray) const {
    if (!is_traceable(ray)) return std::nullopt;
    Search search(ray);
    for (uint instance = 0; instance < reference_.instance_count(); ++instance) {
        const Line line = object_line(ray, reference_.placement(instance));
        for (const ActiveTriangle& triangle : reference_.geometry(instance).active())
            if (const auto met = crossing(line, triangle.vertices64()))
                search.offer(*met, {instance, triangle.primitive});
    }
    return search.best;
}

ReferenceHit to_float64(const std::optional<ClosestHit>& hit, const ReferenceScene& reference) {
    if (!hit) return {};
    const auto [instance, primitive] = hit->triangles.front();
    const Crossing& at = hit->crossing;
    return {true,
            rounded(at.t),
            rounded(at.u),
            rounded(at.v),
            primitive,
            instance,
            reference.options(instance).custom_index,
            at.along == reference.options(instance).flip_facing};
}

}  // namespace twinray::exact
