// SPDX-License-Identifier: MIT
// Accelerators without a hierarchy, in float32, as models of what a GPU kernel answers: the honest one rounds like a
// watertight kernel and must never be called at fault; the other leaks at edges and must be caught.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "engine/core/ray.h"
#include <twinray/geometry.h>
#include "validation/reference/reference_scene.h"
#include "tests/validation/reference/meshes.h"

namespace twinray::test {

struct TriangleHit32 {
    float t, u, v;
};

// Woop et al. 2013 in float32, zero counts as inside, with edge functions that are right to a rounding.
inline std::optional<TriangleHit32> watertight32(vec3 o, vec3 d, const std::array<vec3, 3>& vertices) {
    const vec3 size = abs(d);
    const int kz = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const int kx = (kz + 1) % 3, ky = (kz + 2) % 3;
    const float sx = d[kx] / d[kz], sy = d[ky] / d[kz], sz = 1.0f / d[kz];
    std::array<vec3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
        const vec3 q = vertices[i] - o;
        p[i] = vec3(q[kx] - sx * q[kz], q[ky] - sy * q[kz], sz * q[kz]);
    }
    std::array<float, 3> weight{};
    for (std::size_t i = 0; i < 3; ++i) {
        const vec3& a = p[(i + 2) % 3];
        const vec3& b = p[(i + 1) % 3];
        weight[i] = float(double{a.x} * double{b.y} - double{a.y} * double{b.x});
    }
    const auto [least, most] = std::minmax({weight[0], weight[1], weight[2]});
    const float sum = weight[0] + weight[1] + weight[2];
    if ((least < 0 && most > 0) || sum == 0) return std::nullopt;
    const float t = (weight[0] * p[0].z + weight[1] * p[1].z + weight[2] * p[2].z) / sum;
    return TriangleHit32{t, weight[1] / sum, weight[2] / sum};
}

// Moeller and Trumbore 1997.
inline std::optional<TriangleHit32> leaky32(vec3 o, vec3 d, const std::array<vec3, 3>& vertices) {
    const vec3 e1 = vertices[1] - vertices[0], e2 = vertices[2] - vertices[0], s = o - vertices[0];
    const vec3 q = cross(d, e2), r = cross(s, e1);
    const float inverse = 1.0f / dot(e1, q);
    const float u = dot(s, q) * inverse, v = dot(d, r) * inverse;
    if (!(u >= 0 && v >= 0 && u + v <= 1)) return std::nullopt;
    return TriangleHit32{dot(e2, r) * inverse, u, v};
}

using Test32 = std::optional<TriangleHit32> (*)(vec3, vec3, const std::array<vec3, 3>&);

struct Scene32 {
    std::vector<Soup> soups;
    std::vector<ReferenceInstance> instances;

    ReferenceScene reference() const { return reference_of(soups, instances); }

    // Closest hit by testing every triangle in float32.
    Hit trace(const Ray& ray, Test32 test) const {
        Hit best = miss();
        for (uint i = 0; is_traceable(ray) && i < instances.size(); ++i) {
            const Transform& placed = instances[i].object_to_world;
            const Transform w = inverse(placed, "test");
            const vec4 o(ray.origin, 1), d(ray.direction, 0);
            const bool moves = placed != Transform{};
            const vec3 o_local = moves ? vec3(dot(w.rows[0], o), dot(w.rows[1], o), dot(w.rows[2], o)) : ray.origin;
            const vec3 d_local = moves ? vec3(dot(w.rows[0], d), dot(w.rows[1], d), dot(w.rows[2], d)) : ray.direction;
            const Soup& soup = soups[instances[i].geometry];
            for (uint k = 0; k < soup.triangles.size(); ++k) {
                const uvec3 t = soup.triangles[k];
                const std::array vertices = {soup.positions[t.x], soup.positions[t.y], soup.positions[t.z]};
                const auto hit = test(o_local, d_local, vertices);
                if (hit && hit->t > ray.t_min && hit->t < ray.t_max && (best.hit == 0 || hit->t < best.t))
                    best = {1, hit->t, k, 0, hit->u, hit->v, i, 0};
            }
        }
        return best;
    }
};
inline Scene32 one(const Soup& soup, const Transform& transform = {}) { return {{soup}, {{0, transform, 0}}}; }

// What a kernel that refines its result reports: t, u and v of the same triangle's plane, in float64, unless that t
// leaves the ray's interval.
inline Hit refined(const ReferenceScene& reference, const Ray& ray, Hit hit) {
    if (hit.hit == 0) return hit;
    const ActiveTriangle* triangle = reference.geometry(hit.instance_index).find(hit.primitive_index);
    const Placement64& placement = reference.placement(hit.instance_index);
    const Triangle64 vertices = triangle->vertices64();
    const dvec3 o = placement.point_to_object(dvec3(ray.origin));
    const dvec3 d = placement.vector_to_object(dvec3(ray.direction));
    const dvec3 e1 = vertices[1] - vertices[0], e2 = vertices[2] - vertices[0], s = o - vertices[0];
    const double sum = dot(e1, cross(d, e2));
    const float t = float(dot(e2, cross(s, e1)) / sum);
    if (!(t > ray.t_min && t < ray.t_max)) return hit;
    hit.t = t;
    hit.u = float(dot(s, cross(d, e2)) / sum);
    hit.v = float(dot(d, cross(s, e1)) / sum);
    return hit;
}

}  // namespace twinray::test
