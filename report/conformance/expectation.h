// SPDX-License-Identifier: MIT
// The primitives that a ray meets, by brute force in float64, each with how certain it is in float32.
#pragma once

#include <vector>

#include "report/conformance/query.h"
#include "report/conformance/scene_input.h"
#include "validation/reference/error_bounds.h"

namespace twinray::conformance {

// Vulkan's rules for what a ray may meet: flags of geometries, instances and rays.

// Flags of a ray, with SPIR-V's values.
enum RayFlag : uint {
    ray_opaque = 0x1,
    ray_no_opaque = 0x2,
    ray_terminates = 0x4,         // on the first hit
    ray_skips_closest_hit = 0x8,  // shaders, which a query does not have
    ray_culls_back = 0x10,
    ray_culls_front = 0x20,
    ray_culls_opaque = 0x40,
    ray_culls_no_opaque = 0x80,
    ray_skips_triangles = 0x100,
    ray_skips_boxes = 0x200,
};

// The flags that apply where a ray meets a primitive.
struct MetFlags {
    VkGeometryFlagsKHR geometry = 0;
    VkGeometryInstanceFlagsKHR instance = 0;
    uint ray = 0;
};

// The ray's flag overrides the instance's, which overrides the geometry's.
bool is_opaque(const MetFlags& flags);
// The side that (v1 - v0) x (v2 - v0) points to is the front, unless the instance turns it.
bool is_front(const MetFlags& flags, bool sees_normal_side);
bool is_culled_triangle(const MetFlags& flags, bool sees_normal_side);
bool is_culled_box(const MetFlags& flags);

// A primitive that a driver must or may offer to a ray.
struct Candidate {
    uint instance = 0, geometry = 0, primitive = 0;
    bool is_box = false;
    bool is_sure = false;  // no rounding of float32 excuses its absence
    bool is_front = false;
    bool is_opaque = false;
    bool is_offered_once = false;  // VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR
    double t_low = 0, t_high = 0;  // triangles: where a driver finds it; boxes: from one side to the other

    uint name() const { return candidate_name(is_box, instance, geometry, primitive); }
};

// A scene in float64. Immutable, so threads may share it.
class Expectation {
  public:
    // Copies what it needs. The product of a geometry's transform with the instance's must be exact.
    explicit Expectation(const SceneInput& scene);

    // Returns all candidates that masks, flags and the interval leave, by instance, geometry and primitive. A driver
    // may offer any box, so all boxes are there.
    std::vector<Candidate> candidates(const Shot& shot) const;

    // Returns whether u and v name a point that lies within rounding of the ray.
    bool is_on_ray(const Shot& shot, const Candidate& candidate, vec2 uv) const;
    // Returns whether the driver's ray in the instance's space is right up to rounding.
    bool is_object_ray(const Shot& shot, uint instance, vec3 origin, vec3 direction) const;
    const InstanceInput& instance(uint index) const { return instances_[index]; }

  private:
    struct Triangle {
        uint primitive;
        Triangle64 vertices;
        dvec3 center;
        double radius;
    };
    struct PlacedGeometry {
        VkGeometryFlagsKHR flags;
        Placement64 placement;
        bool is_mirrored;  // by its own transform, which a build applies: the front is that of the moved triangle
        std::vector<Triangle> triangles;
        std::vector<Bounds> boxes;
    };
    static PlacedGeometry placed(const GeometryInput& geometry, const Transform& to_world);
    void add_triangles(const Shot& shot, Candidate candidate, const PlacedGeometry& geometry,
                       std::vector<Candidate>& found) const;
    void add_boxes(const Shot& shot, Candidate candidate, const PlacedGeometry& geometry,
                   std::vector<Candidate>& found) const;

    std::vector<InstanceInput> instances_;
    std::vector<std::vector<PlacedGeometry>> geometries_;  // of each instance
    std::vector<Placement64> placements_;
};

}  // namespace twinray::conformance
