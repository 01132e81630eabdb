#include "report/reproducer/simplify.h"

#include <algorithm>
#include <bit>
#include <map>

#include "engine/accel/geometry.h"
#include "engine/accel/morton_order.h"
#include "validation/reference/geometry64.h"

namespace twinray::reproducer {
namespace {

// Computes in float64, in world space.
bool is_near(const CaseTriangle& triangle, const Transform& transform, const Ray& ray) {
    Box64 box;
    for (const vec3& vertex : triangle.vertices) box.include(dvec3(transform_point(transform, vertex)));
    const dvec3 size = box.corners[1] - box.corners[0];
    const SlabRay slabs(dvec3(ray.origin), dvec3(ray.direction), 0.25 * std::max({size.x, size.y, size.z}));
    return !slabs.clip(box).is_empty();
}

}  // namespace

FaultCase near_the_ray(const FaultCase& fault, std::size_t instance, std::size_t also) {
    FaultCase near{fault.transforms, {}, fault.ray};
    std::vector<std::size_t> counts(fault.transforms.size());
    for (const CaseTriangle& triangle : fault.triangles) {
        const bool is_wanted = triangle.instance == instance && counts[triangle.instance] == also;
        ++counts[triangle.instance];
        if (is_wanted || is_near(triangle, fault.transforms[triangle.instance], fault.ray))
            near.triangles.push_back(triangle);
    }
    return near;
}

FaultCase case_of(const Scene& scene, const Ray& ray, bool reorders) {
    FaultCase fault;
    fault.ray = ray;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        std::vector<uvec3> triangles = mesh.triangles;
        if (reorders) {
            const std::vector<uint> order = morton_order(triangle_centers(mesh.positions, mesh.triangles));
            std::ranges::transform(order, triangles.begin(), [&](uint i) { return mesh.triangles[i]; });
        }
        for (const uvec3& t : triangles) {
            const std::array<vec3, 3> vertices = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
            if (std::ranges::all_of(vertices, [](const vec3& v) { return is_finite(v); }))
                fault.triangles.push_back({fault.transforms.size(), vertices});
        }
        fault.transforms.push_back(instance.transform);
    }
    return fault;
}

FaultCase as_built(const FaultCase& fault) {
    FaultCase built = fault;
    for (std::size_t instance = 0; instance < built.transforms.size(); ++instance) {
        std::vector<vec3> vertices;
        for (const CaseTriangle& triangle : fault.triangles)
            if (triangle.instance == instance)
                vertices.insert(vertices.end(), triangle.vertices.begin(), triangle.vertices.end());
        const float unit = Geometry::near_unit(vertices);
        for (CaseTriangle& triangle : built.triangles)
            if (triangle.instance == instance)
                for (vec3& vertex : triangle.vertices) vertex *= 1 / unit;
        for (vec4& row : built.transforms[instance].rows) row = vec4(vec3(row) * unit, row.w);
    }
    return built;
}

Scene scene_of(const FaultCase& fault) {
    Scene scene;
    for (std::size_t instance = 0; instance < fault.transforms.size(); ++instance) {
        Mesh mesh;
        std::map<std::array<std::uint32_t, 3>, uint> numbers;  // of vertices, by their bits
        for (const CaseTriangle& triangle : fault.triangles) {
            if (triangle.instance != instance) continue;
            uvec3& corners = mesh.triangles.emplace_back(0u);
            for (int k = 2; k >= 0; --k) {
                const vec3& p = triangle.vertices[static_cast<std::size_t>(k)];
                const auto [at, is_new] = numbers.try_emplace(std::bit_cast<std::array<std::uint32_t, 3>>(p),
                                                              static_cast<uint>(mesh.positions.size()));
                if (is_new) mesh.positions.push_back(p);
                corners[k] = at->second;
            }
        }
        if (mesh.triangles.empty()) continue;
        scene.instances.push_back({"", static_cast<uint>(scene.meshes.size()), fault.transforms[instance]});
        scene.meshes.push_back(std::move(mesh));
    }
    return scene;
}

}  // namespace twinray::reproducer
