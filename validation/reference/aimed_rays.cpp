#include "validation/reference/aimed_rays.h"

#include "engine/core/interruption.h"

namespace twinray {
namespace {

Ray endless(const vec3& origin, const dvec3& direction) {
    return {origin, 0.0f, vec3(direction), std::numeric_limits<float>::infinity()};
}

vec3 to_finite(const dvec3& p) {
    constexpr double largest = std::numeric_limits<float>::max();
    return vec3(clamp(p, dvec3(-largest), dvec3(largest)));
}

// Returns a length to place origins by: that of the coordinates if the box has no extent.
double diagonal_of(const Box64& box) {
    const double diagonal = box.is_empty() ? 0 : length(box.corners[1] - box.corners[0]);
    if (diagonal > 0) return diagonal;
    return box.max_abs() > 0 ? box.max_abs() : 1.0;
}

// Returns the instances with an active triangle.
std::vector<uint> targets_of(const ReferenceScene& scene) {
    std::vector<uint> targets;
    for (uint i = 0; i < scene.instance_count(); ++i)
        if (!scene.geometry(i).active().empty()) targets.push_back(i);
    return targets;
}

// Returns the vertices of a random active triangle, in world space.
Triangle64 draw_triangle(Draws& draws, const ReferenceScene& scene, const std::vector<uint>& targets) {
    const uint instance = targets[draws.below(targets.size())];
    const Geometry64& geometry = scene.geometry(instance);
    uint primitive = draws.below(geometry.triangle_count());
    while (geometry.find(primitive) == nullptr) primitive = (primitive + 1) % uint(geometry.triangle_count());
    Triangle64 vertices = geometry.find(primitive)->vertices64();
    const Placement64& placement = scene.placement(instance);
    for (dvec3& vertex : vertices) vertex = placement.to_world * vertex + placement.offset;
    return vertices;
}

// pick(draws, vertices) chooses the point of a triangle to aim at.
template <class Pick>
std::vector<Ray> aimed_rays(const ReferenceScene& scene, std::size_t count, std::uint64_t seed, const Pick& pick) {
    const std::vector<uint> targets = targets_of(scene);
    if (targets.empty()) return random_rays({}, count, seed);
    std::vector<Ray> rays;
    rays.reserve(count);
    LoopInterruption interruption;
    for (std::size_t i = 0; i < count; ++i) {
        interruption.look();
        Draws draws(seed, i);
        const dvec3 target = pick(draws, draw_triangle(draws, scene, targets));
        double distance = draws.between(0.05, 2.0) * diagonal_of(scene.bounds());
        vec3 origin = to_finite(target + distance * draws.direction());
        while (dvec3(origin) == target) {  // rounding swallows the distance of a tiny, far triangle
            distance *= 2;
            origin = to_finite(target + distance * draws.direction());
        }
        rays.push_back(endless(origin, normalize(target - dvec3(origin))));
    }
    return rays;
}

}  // namespace

std::vector<Ray> random_rays(const Bounds& bounds, std::size_t count, std::uint64_t seed) {
    Box64 box;
    box.include(bounds.is_empty() ? dvec3(-0.5) : dvec3(bounds.lo));
    box.include(bounds.is_empty() ? dvec3(0.5) : dvec3(bounds.hi));
    std::vector<Ray> rays;
    rays.reserve(count);
    LoopInterruption interruption;
    for (std::size_t i = 0; i < count; ++i) {
        interruption.look();
        Draws draws(seed, i);
        const double margin = diagonal_of(box) * (i % 2 == 0 ? 0.1 : 1.0);
        dvec3 origin;
        for (int axis = 0; axis < 3; ++axis)
            origin[axis] = draws.between(box.corners[0][axis] - margin, box.corners[1][axis] + margin);
        rays.push_back(endless(to_finite(origin), draws.direction()));
    }
    return rays;
}

std::vector<Ray> vertex_aimed_rays(const ReferenceScene& scene, std::size_t count, std::uint64_t seed) {
    return aimed_rays(scene, count, seed,
                      [](Draws& draws, const Triangle64& vertices) { return vertices[draws.below(3)]; });
}

std::vector<Ray> edge_aimed_rays(const ReferenceScene& scene, std::size_t count, std::uint64_t seed) {
    return aimed_rays(scene, count, seed, [](Draws& draws, const Triangle64& vertices) {
        const uint edge = draws.below(3);
        const double w = draws.unit();
        return (1 - w) * vertices[edge] + w * vertices[(edge + 1) % 3];
    });
}

std::vector<Ray> primary_rays(const Bounds& bounds, uint width) {
    const vec3 target = bounds.center();
    const vec3 eye = target + normalize(vec3(0.6f, 0.4f, 1.0f)) * (1.2f * length(bounds.size()));
    const vec3 forward = normalize(target - eye);
    const vec3 right = normalize(cross(forward, vec3(0, 1, 0)));
    const vec3 up = cross(right, forward);
    const float half = 0.45f;  // tangent of half the field of view
    std::vector<Ray> rays;
    for (uint tile = 0; tile < width / 8 * (width / 8); ++tile)
        for (uint pixel = 0; pixel < 64; ++pixel) {
            const uint x = tile % (width / 8) * 8 + pixel % 8, y = tile / (width / 8) * 8 + pixel / 8;
            const vec2 p = (vec2(x, y) + 0.5f) / static_cast<float>(width) * 2.0f - 1.0f;
            rays.push_back({eye, 0, normalize(forward + (right * p.x - up * p.y) * half), INFINITY});
        }
    return rays;
}

}  // namespace twinray
