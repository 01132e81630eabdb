// SPDX-License-Identifier: MIT
#include "bench/rays.h"

#include <cmath>

#include <twinray/scene.h>

#include "twinray/glsl/cpp_spawn.h"
#include "engine/core/error.h"
#include "validation/reference/aimed_rays.h"
#include "validation/reference/draws.h"
#include <twinray/tlas.h>

namespace twinray::bench {
namespace {

// Returns the point of ray i of `count`.
const Surface& point_of(std::span<const Surface> points, std::size_t i, std::size_t count) {
    return points[i * points.size() / count];
}

std::vector<Hit> primary_hits(Context& context, const Scene& scene, std::span<const Ray> rays) {
    const bool can_refine =
        SwTlas::capability_on(context.properties(), Feature::level_refined).support != Support::unsupported;
    const Level level = can_refine ? Level::refined : Level::watertight;
    SwTlas accel(context, AccelOptions{.level = level});
    push_scene(accel, scene);
    return accel.closest_hits(rays, {.level = level});
}

// Returns a box above and beside `bounds`, clear of it, with sides of a quarter of its diagonal.
Bounds light_of(const Bounds& bounds) {
    const float diagonal = length(bounds.size());
    const vec3 center = bounds.center() + vec3(-0.4f, 0.9f, 0.4f) * diagonal;
    return {center - 0.125f * diagonal, center + 0.125f * diagonal};
}

}  // namespace

std::vector<Surface> surfaces_of(const Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits) {
    std::vector<Placement> placements;
    for (const Instance& instance : scene.instances) {
        const auto& rows = instance.transform.rows;
        placements.push_back(placement_of(Rows{rows[0], rows[1], rows[2]}));
    }
    std::vector<Surface> points;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const Hit& hit = hits[i];
        if (!hit.hit) continue;
        const Mesh& mesh = scene.meshes[scene.instances[hit.instance_index].mesh];
        const uvec3 triangle = mesh.triangles[hit.primitive_index];
        const SurfacePoint point = surface_point(
            placements[hit.instance_index],
            {mesh.positions[triangle.x], mesh.positions[triangle.y], mesh.positions[triangle.z]}, vec2(hit.u, hit.v));
        points.push_back({spawn_position(point, true), spawn_position(point, false), point.normal,
                          dot(rays[i].direction, point.normal) < 0});
    }
    return points;
}

std::vector<Ray> incoherent_rays(std::span<const Surface> points, std::size_t count, std::uint64_t seed) {
    std::vector<Ray> rays;
    rays.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Surface& point = point_of(points, i, count);
        vec3 direction(Draws(seed, i).direction());
        if ((dot(direction, point.normal) > 0) != point.is_front) direction = -direction;
        rays.push_back({point.is_front ? point.front : point.back, 0, direction, INFINITY});
    }
    return rays;
}

std::vector<Ray> occlusion_rays(std::span<const Surface> points, const Bounds& bounds, std::size_t count,
                                std::uint64_t seed) {
    const Bounds light = light_of(bounds);
    std::vector<Ray> rays;
    rays.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Surface& point = point_of(points, i, count);
        Draws draws(~seed, i);
        const double x = draws.unit(), y = draws.unit(), z = draws.unit();
        const vec3 target = light.lo + light.size() * vec3(x, y, z);
        const vec3 origin = dot(target - point.front, point.normal) > 0 ? point.front : point.back;
        const float distance = length(target - origin);
        rays.push_back({origin, 0, (target - origin) / distance, std::nextafter(distance, 0.0f)});
    }
    return rays;
}

std::vector<Ray> shuffled_rays(std::vector<Ray> rays, std::uint64_t seed) {
    for (std::size_t left = rays.size(); left > 1; --left)
        std::swap(rays[left - 1], rays[Draws(seed, left).below(left)]);
    return rays;
}

std::array<std::vector<Ray>, all_ray_kinds.size()> make_rays(Context& context, const BenchScene& scene, uint width,
                                                             std::uint64_t seed) {
    const std::vector<Ray> primary = primary_rays(scene.framed, width);
    const std::vector<Surface> points = surfaces_of(scene.scene, primary, primary_hits(context, scene.scene, primary));
    if (points.empty()) fail("scene '", scene.name, "': none of ", primary.size(), " primary rays meets it");
    const std::vector<Ray> incoherent = incoherent_rays(points, primary.size(), seed);
    return {primary, incoherent, occlusion_rays(points, bounds_of(scene.scene), primary.size(), seed),
            shuffled_rays(incoherent, seed)};
}

}  // namespace twinray::bench
