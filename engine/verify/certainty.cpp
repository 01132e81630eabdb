// SPDX-License-Identifier: MIT
#include "engine/verify/certainty.h"

#include <algorithm>

#include "engine/verify/tube.h"

namespace twinray {
namespace {

Tube tube_of(const Oracle& oracle, const Ray& ray, uint instance) {
    return {ray, oracle.placement(instance), Accelerator::referee};
}

bool is_certainly_met(const Footprint& footprint, double t_min, double t_max) {
    return footprint.margin > footprint.radius && footprint.t_low > t_min && footprint.t_high < t_max;
}

bool is_certainly_missed(const Footprint& footprint, double t_min, double t_max) {
    return footprint.margin < -footprint.radius || footprint.t_high <= t_min || footprint.t_low >= t_max;
}

}  // namespace

bool is_certain(const Oracle& oracle, const Ray& ray, const OracleHit& reference) {
    if (!is_traceable(ray)) return true;
    const double t_min = std::max(0.0, double{ray.t_min});
    double t_end = ray.t_max;  // what lies behind it for certain cannot be the closest hit
    if (reference.hit) {
        const Triangle64 triangle = oracle.geometry(reference.instance).find(reference.primitive)->corners64();
        const Footprint expected = tube_of(oracle, ray, reference.instance).footprint(triangle);
        if (!is_certainly_met(expected, t_min, ray.t_max)) return false;
        t_end = expected.t_high;
    }
    for (const uint instance : oracle.instances_near(ray)) {
        const Geometry64& geometry = oracle.geometry(instance);
        const Tube tube = tube_of(oracle, ray, instance);
        bool is_clear = true;
        geometry.visit(
            tube.slabs(tube.max_radius(geometry.bounds())), t_min, t_end, [&](const ActiveTriangle& triangle) {
                const bool is_expected =
                    reference.hit && instance == reference.instance && triangle.primitive == reference.primitive;
                is_clear = is_expected || is_certainly_missed(tube.footprint(triangle.corners64()), t_min, t_end);
                return is_clear;
            });
        if (!is_clear) return false;
    }
    return true;
}

}  // namespace twinray
