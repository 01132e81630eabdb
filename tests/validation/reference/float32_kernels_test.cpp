// The classifier, tested with an accelerator without a hierarchy, in float32, as a model of a GPU kernel: it rounds
// like a watertight kernel and must never be called at fault.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include <twinray/geometry.h>
#include "engine/core/ray.h"
#include "tests/validation/reference/meshes.h"
#include "validation/reference/aimed_rays.h"
#include "validation/reference/classify.h"

namespace twinray {
namespace {

using namespace test;  // NOLINT

struct TriangleHit32 {
    float t, u, v;
};

// Tests as Woop et al. 2013 do, in float32, where zero counts as inside, with edge functions that are right to a
// rounding.
std::optional<TriangleHit32> watertight32(vec3 o, vec3 d, const std::array<vec3, 3>& vertices) {
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

struct Scene32 {
    std::vector<Soup> soups;
    std::vector<ReferenceInstance> instances;

    ReferenceScene reference() const { return reference_of(soups, instances); }

    // Finds the closest hit by testing every triangle in float32.
    Hit trace(const Ray& ray) const {
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
                const auto hit = watertight32(o_local, d_local, vertices);
                if (hit && hit->t > ray.t_min && hit->t < ray.t_max && (best.hit == 0 || hit->t < best.t))
                    best = {1, hit->t, k, 0, hit->u, hit->v, i, 0};
            }
        }
        return best;
    }
};
Scene32 one(const Soup& soup, const Transform& transform = {}) { return {{soup}, {{0, transform, 0}}}; }

// Returns the result of a kernel that refines: t, u and v of the same triangle's plane, in float64, unless that t
// leaves the ray's interval.
Hit refined(const ReferenceScene& reference, const Ray& ray, Hit hit) {
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

struct Tally {
    HitClassCounts software, hardware;
};

// Traces random and aimed rays with the kernel as both accelerators, and at its refined level.
Tally tally(const Scene32& scene, std::size_t count, std::uint64_t seed) {
    const ReferenceScene reference = scene.reference();
    const Bounds bounds{vec3(reference.bounds().corners[0]), vec3(reference.bounds().corners[1])};
    std::vector<Ray> rays = random_rays(bounds, count, seed);
    for (const auto& more : {vertex_aimed_rays(reference, count, seed), edge_aimed_rays(reference, count, seed)})
        rays.insert(rays.end(), more.begin(), more.end());
    std::vector<Hit> hits;
    for (const Ray& ray : rays) hits.push_back(scene.trace(ray));
    Tally result;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const RayResult ray_result = classify(reference, rays[i], hits[i], hits[i]);
        result.software.add(*ray_result.software);
        result.hardware.add(*ray_result.hardware);
        result.software.add(*classify(reference, rays[i], refined(reference, rays[i], hits[i]), {}).software);
        const RayResult any = classify_any(reference, rays[i], hits[i].hit != 0, hits[i].hit != 0);
        result.software.add(*any.software);
        result.hardware.add(*any.hardware);
    }
    return result;
}

void expect_no_fault(const Scene32& scene, std::uint64_t seed) {
    const Tally result = tally(scene, 1500, seed);
    EXPECT_EQ(result.software.faults_of_ours(), 0u) << "seed " << seed;
    for (std::size_t i = 0; i < hit_class_count; ++i) {
        const HitClass kind = static_cast<HitClass>(i);
        const bool is_wrong = is_fault_of_ours(kind) || kind == HitClass::hw_leak || kind == HitClass::hw_false ||
                              kind == HitClass::hw_t_err || kind == HitClass::hw_range;
        if (is_wrong) {
            EXPECT_EQ(result.software[kind] + result.hardware[kind], 0u) << name_of(kind) << ", seed " << seed;
        }
    }
    EXPECT_GT(result.software[HitClass::agree], result.software.total() / 4) << "seed " << seed;
}

Soup slivers(std::uint32_t seed, float width) {
    std::mt19937 random(seed);
    Soup soup;
    for (int i = 0; i < 300; ++i) {
        const vec3 a = uniform3(random, -1, 1);
        const vec3 b = uniform3(random, -1, 1);
        soup.add(a, b, mix(a, b, uniform(random, 0, 1)) + width * uniform3(random, -1, 1));
    }
    return soup;
}

TEST(HonestKernel, HasNoFaultOnSoupsSliversGridsAndClosedMeshes) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        expect_no_fault(one(random_soup(300, 0.5f, seed)), seed);
        expect_no_fault(one(random_soup(300, 0.02f, seed)), seed);
    }
    for (const float width : {1e-2f, 1e-4f, 1e-6f})
        for (std::uint32_t seed = 1; seed <= 3; ++seed) expect_no_fault(one(slivers(seed, width)), seed);
    expect_no_fault(one(grid(14, 0, 0, 1)), 11);
    expect_no_fault(one(grid(14, 0.3f, 0.3f, 1)), 12);
    expect_no_fault(one(sphere(3)), 13);
    expect_no_fault(one(cube()), 14);
}

TEST(HonestKernel, HasNoFaultFarFromTheOrigin) {
    Soup far = grid(14, 0.3f, 0.3f, 1);
    for (vec3& p : far.positions) p += vec3(1e5f, -1e5f, 1e5f);
    expect_no_fault(one(far), 31);
    expect_no_fault(one(sphere(3), Transform::translation({1e4f, -1e4f, 1e4f}) * rotation(0.7f, 0.4f)), 32);
}

TEST(HonestKernel, HasNoFaultUnderTransforms) {
    const Transform turned = rotation(0.7f, 0.4f);
    expect_no_fault(one(sphere(3), turned), 41);
    expect_no_fault(one(sphere(3), turned * Transform::scaling({-1, 30, 0.02f})), 42);
    const Scene32 many = {{sphere(2), cube(), grid(8, 0, 0, 1)},
                          {{0, turned, 0},
                           {1, Transform::translation({1, 0, 0}), 0},
                           {1, {}, 0},
                           {2, turned, 0},
                           {0, Transform::translation({0, 3, 1}) * Transform::scaling({2, 2, 2}), 0}}};
    expect_no_fault(many, 43);
}

}  // namespace
}  // namespace twinray
