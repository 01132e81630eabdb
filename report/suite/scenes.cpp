// SPDX-License-Identifier: MIT
#include "report/suite/scenes.h"

#include <twinray/scene.h>

#include "validation/reference/aimed_rays.h"

namespace twinray::suite {
namespace {

// Drops the attributes, because the mesh gets vertices without entries in them.
void drop_attributes(Mesh& mesh) {
    mesh.normals.clear();
    mesh.uvs.clear();
}

}  // namespace

vec3 Random::in_box(float extent) {
    const float x = between(-extent, extent), y = between(-extent, extent);
    return {x, y, between(-extent, extent)};
}

vec2 Random::in_triangle() {
    const float u = between(0, 1), v = between(0, 1);
    return u + v <= 1 ? vec2(u, v) : vec2(1 - u, 1 - v);
}

vec3 Random::direction() {
    for (;;) {
        const dvec3 p(in_box(1));
        const double square = dot(p, p);
        if (square <= 1 && square > 0x1p-20) return vec3(p / std::sqrt(square));
    }
}

// Returns the rotation of a random unit quaternion (by rejection, as uniform on the sphere of dimension 4), evaluated
// in float64.
Transform Random::rotation() {
    for (;;) {
        const double w = between(-1, 1), x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
        const double square = w * w + x * x + y * y + z * z;
        if (square > 1 || square < 0.01) continue;
        const double s = 2 / square;
        Transform result;
        result.rows[0] = vec4(1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y), 0);
        result.rows[1] = vec4(s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x), 0);
        result.rows[2] = vec4(s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y), 0);
        return result;
    }
}

dvec3 Random::weights(double least) {
    for (;;) {
        const double u = between(0, 1), v = between(0, 1);
        if (u >= least && v >= least && 1 - u - v >= least) return {1 - u - v, u, v};
    }
}

void add_triangle(Mesh& mesh, vec3 a, vec3 b, vec3 c) {
    drop_attributes(mesh);
    const uint first = static_cast<uint>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
}

void append(Mesh& mesh, const Mesh& part) {
    drop_attributes(mesh);
    const uint base = static_cast<uint>(mesh.positions.size());
    for (const uvec3& triangle : part.triangles) mesh.triangles.push_back(triangle + base);
    mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
}

Mesh scaled(Mesh mesh, float factor) {
    for (vec3& position : mesh.positions) position *= factor;
    return mesh;
}

Mesh moved(Mesh mesh, vec3 offset) {
    for (vec3& position : mesh.positions) position += offset;
    return mesh;
}

Scene instances_of(const Mesh& mesh, const std::vector<Transform>& transforms) {
    Scene scene;
    scene.meshes = {mesh};
    for (const Transform& transform : transforms) scene.instances.push_back({"", 0, transform});
    return scene;
}

vec3 turned(vec3 v, int times) {
    for (; times > 0; --times) v = vec3(v.z, v.x, v.y);
    return v;
}

std::vector<Ray> scaled(std::vector<Ray> rays, float factor) {
    for (Ray& ray : rays) ray.origin *= factor;
    return rays;
}

ScaledPlace scaled_place(Random& random, float most) {
    vec3 factors;
    for (int axis = 0; axis < 3; ++axis) factors[axis] = std::pow(10.0f, random.between(-most, most));
    const int least = factors.x < factors.y ? (factors.x < factors.z ? 0 : 2) : (factors.y < factors.z ? 1 : 2);
    vec3 along(0);
    along[least] = 1;
    const Transform place = random.rotation() * Transform::scaling(factors);
    return {place, {transform_vector(place, -3.0f * along), 0, transform_vector(place, along), inf}};
}

Ray ray_to(const dvec3& target, const dvec3& origin) {
    const vec3 rounded(origin);
    return {rounded, 0, vec3(normalize(target - dvec3(rounded))), inf};
}

std::vector<Ray> random_and_aimed(const ReferenceScene& reference, const Bounds& bounds, std::size_t random,
                                  std::size_t aimed, std::uint64_t seed) {
    std::vector<Ray> rays = random_rays(bounds, random, seed);
    for (const auto& more : {vertex_aimed_rays(reference, aimed, seed), edge_aimed_rays(reference, aimed, seed)})
        rays.insert(rays.end(), more.begin(), more.end());
    return rays;
}

std::vector<Ray> mixed_rays(const World& world, const Bounds& bounds, std::size_t count, std::uint64_t seed) {
    return random_and_aimed(world.reference, bounds, count / 2, count / 4, seed);
}

}  // namespace twinray::suite
