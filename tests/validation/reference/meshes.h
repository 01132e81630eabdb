// Small meshes and transforms for the tests of the reference.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "engine/core/ray.h"
#include <twinray/geometry.h>
#include "engine/scene/mesh.h"
#include "validation/reference/reference_scene.h"

namespace twinray::test {

struct Soup {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles;

    MeshView view() const { return {"test", positions, triangles}; }
    void add(vec3 a, vec3 b, vec3 c) {
        const uint first = static_cast<uint>(positions.size());
        positions.insert(positions.end(), {a, b, c});
        triangles.push_back({first, first + 1, first + 2});
    }
};

inline ReferenceScene reference_of(const std::vector<Soup>& soups, const std::vector<ReferenceInstance>& instances) {
    std::vector<MeshView> views;
    for (const Soup& soup : soups) views.push_back(soup.view());
    return {views, instances};
}

inline ReferenceScene reference_of(const Soup& soup, const Transform& transform = {}) {
    return reference_of(std::vector<Soup>{soup}, {{0, transform, 0}});
}

inline Ray make_ray(vec3 origin, vec3 direction, float t_min = 0, float t_max = INFINITY) {
    return {origin, t_min, direction, t_max};
}

// Returns a uniform number in [low, high), the same on every platform.
inline float uniform(std::mt19937& random, float low, float high) {
    return low + (high - low) * static_cast<float>(random() >> 8) * 0x1p-24f;
}

inline vec3 uniform3(std::mt19937& random, float low, float high) {
    const float x = uniform(random, low, high);
    const float y = uniform(random, low, high);
    return {x, y, uniform(random, low, high)};
}

inline Soup random_soup(std::size_t count, float size, std::uint32_t seed) {
    std::mt19937 random(seed);
    Soup soup;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 center = uniform3(random, -1, 1);
        const vec3 a = center + uniform3(random, -size, size);
        const vec3 b = center + uniform3(random, -size, size);
        soup.add(a, b, center + uniform3(random, -size, size));
    }
    return soup;
}

// Makes n x n cells of size 1 in z = 0, moved by up to `jitter` in x and y and `height` in z; indexed.
inline Soup grid(uint n, float jitter, float height, std::uint32_t seed) {
    std::mt19937 random(seed);
    Soup soup;
    for (uint y = 0; y <= n; ++y)
        for (uint x = 0; x <= n; ++x)
            soup.positions.push_back(vec3(x, y, 0) + uniform3(random, -1, 1) * vec3(jitter, jitter, height));
    for (uint y = 0; y < n; ++y) {
        for (uint x = 0; x < n; ++x) {
            const uint i = y * (n + 1) + x;
            soup.triangles.push_back({i, i + 1, i + n + 2});
            soup.triangles.push_back({i, i + n + 2, i + n + 1});
        }
    }
    return soup;
}

// Each level splits every triangle of an octahedron into four, on the unit sphere: 8 * 4^level triangles, closed.
inline Soup sphere(int level) {
    Soup soup;
    soup.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    soup.triangles = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
    for (int i = 0; i < level; ++i) {
        std::map<std::pair<uint, uint>, uint> middles;
        const auto middle = [&](uint a, uint b) {
            const auto [found, is_new] = middles.try_emplace(std::minmax(a, b), 0u);
            if (is_new) {
                found->second = static_cast<uint>(soup.positions.size());
                soup.positions.push_back(normalize(soup.positions[a] + soup.positions[b]));
            }
            return found->second;
        };
        std::vector<uvec3> finer;
        for (const uvec3& t : soup.triangles) {
            const uint ab = middle(t.x, t.y), bc = middle(t.y, t.z), ca = middle(t.z, t.x);
            finer.insert(finer.end(), {{t.x, ab, ca}, {ab, t.y, bc}, {ca, bc, t.z}, {ab, bc, ca}});
        }
        soup.triangles = finer;
    }
    return soup;
}

// Closed unit cube around the origin's positive octant, two triangles a side.
inline Soup cube() {
    Soup soup;
    for (uint i = 0; i < 8; ++i) soup.positions.push_back(vec3(i & 1u, i >> 1 & 1u, i >> 2));
    soup.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return soup;
}

inline Transform rotation(float angle_x, float angle_y) {
    const float cx = std::cos(angle_x), sx = std::sin(angle_x), cy = std::cos(angle_y), sy = std::sin(angle_y);
    return {{vec4(cy, 0, sy, 0), vec4(sx * sy, cx, -sx * cy, 0), vec4(-cx * sy, sx, cx * cy, 0)}};
}

// Scales along axes within 10^most and 10^-most, with a rotation after them and before them.
struct ScaledAndTurned {
    Transform scaling;
    std::array<Transform, 2> both;
};
inline ScaledAndTurned scaled_and_turned(std::mt19937& random, double most) {
    std::uniform_real_distribution<double> exponent(-most, most);
    std::uniform_real_distribution<float> angle(-4, 4);
    const auto power = [&] { return static_cast<float>(std::pow(10.0, exponent(random))); };
    const Transform scaling = Transform::scaling({power(), power(), power()}),
                    turned = rotation(angle(random), angle(random));
    return {scaling, {turned * scaling, scaling * turned}};
}

// Returns a transform that scales, shears, and moves by up to `spread` along each axis.
inline Transform random_instance_transform(std::mt19937& random, float spread) {
    Transform m = Transform::scaling(vec3(uniform(random, 0.5f, 1.5f)));
    for (vec4& row : m.rows) row += vec4(uniform3(random, -0.5f, 0.5f), uniform(random, -spread, spread));
    return m;
}

inline double distance_to_line(const dvec3& point, const Ray& ray) {
    const dvec3 d = normalize(dvec3(ray.direction));
    return length(cross(point - dvec3(ray.origin), d));
}

// Returns rays from inside a mesh around its origin, at its vertices (even ones) and at points of its edges (odd ones).
inline std::vector<Ray> rays_from_inside(const Soup& soup, const Transform& transform, std::size_t count,
                                         std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 origin = transform_point(transform, uniform3(random, -0.3f, 0.3f));
        const uvec3& triangle = soup.triangles[random() % soup.triangles.size()];
        const float w = i % 2 == 0 ? 0.0f : uniform(random, 0, 1);
        const vec3 target = mix(transform_point(transform, soup.positions[triangle.x]),
                                transform_point(transform, soup.positions[triangle.y]), w);
        rays.push_back(make_ray(origin, target - origin));
    }
    return rays;
}

}  // namespace twinray::test
