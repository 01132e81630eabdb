// SPDX-License-Identifier: MIT
#include "validation/reference/certainty.h"

#include <algorithm>

#include "validation/reference/error_bounds.h"

namespace twinray {
namespace {

ErrorBounds error_bounds_of(const ReferenceScene& reference, const Ray& ray, uint instance) {
    return {ray, reference.placement(instance), Accelerator::reference};
}

bool is_certainly_met(const TriangleBound& bound, double t_min, double t_max) {
    return bound.margin > bound.radius && bound.t_low > t_min && bound.t_high < t_max;
}

bool is_certainly_missed(const TriangleBound& bound, double t_min, double t_max) {
    return bound.margin < -bound.radius || bound.t_high <= t_min || bound.t_low >= t_max;
}

}  // namespace

bool is_certain(const ReferenceScene& reference, const Ray& ray, const ReferenceHit& closest) {
    if (!is_traceable(ray)) return true;
    const double t_min = std::max(0.0, double{ray.t_min});
    double t_end = ray.t_max;  // a hit certain to lie behind it cannot be the closest
    if (closest.hit) {
        const Triangle64 triangle = reference.geometry(closest.instance).find(closest.primitive)->vertices64();
        const TriangleBound expected = error_bounds_of(reference, ray, closest.instance).bound(triangle);
        if (!is_certainly_met(expected, t_min, ray.t_max)) return false;
        t_end = expected.t_high;
    }
    for (const uint instance : reference.instances_near(ray)) {
        const Geometry64& geometry = reference.geometry(instance);
        const ErrorBounds bounds = error_bounds_of(reference, ray, instance);
        bool is_clear = true;
        geometry.visit(
            bounds.slabs(bounds.max_radius(geometry.bounds())), t_min, t_end, [&](const ActiveTriangle& triangle) {
                const bool is_expected =
                    closest.hit && instance == closest.instance && triangle.primitive == closest.primitive;
                is_clear = is_expected || is_certainly_missed(bounds.bound(triangle.vertices64()), t_min, t_end);
                return is_clear;
            });
        if (!is_clear) return false;
    }
    return true;
}

}  // namespace twinray
