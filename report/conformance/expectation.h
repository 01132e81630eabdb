// The primitives that a ray meets, by brute force in float64, each with how certain it is in float32; the verdict on a
// driver's answer to a shot, and changes to scenes and rays that must not change what is hit: relations.cpp.
#pragma once

#include "report/conformance/inputs.h"
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

enum class Finding : std::uint8_t {
    agrees,
    rounding,     // an edge, a tie, a limit: accepted, as float32 may decide either way
    lost,         // a miss where something is surely hit
    lost_nearer,  // a hit farther than one that is certain
    false_hit,    // of something that the ray does not meet, or may not by flags and masks
    wrong_t,
    outside_limits,  // a t that the interval excludes
    wrong_ids,       // custom index, record offset, instance, geometry or primitive
    wrong_facing,
    wrong_uv,
    wrong_transform,  // the object's ray, or the map of the instance
    not_offered,      // a candidate that is certain
    offered_again,    // though its geometry allows one
    offered_falsely,
    wrong_opacity,  // of a box
    leak,           // out of a closed mesh, or through a shared edge
    double_hit,     // of a shared edge
    differs,        // from another answer that must be the same
    broken,         // a fault that is not about a ray
};
inline constexpr std::size_t finding_count = 19;
std::string_view name_of(Finding finding);  // "AGREE", "LOST", ...
constexpr bool is_fault(Finding finding) { return finding > Finding::rounding; }

// Judges the committed hit of a ray with the shot's refusals. Boxes are met at the shot's box_t.
Finding judge_hit(const Expectation& expectation, const Shot& shot, const Answer& answer);

// Judges the candidates of a ray that refuses all of them.
Finding judge_candidates(const Expectation& expectation, const Shot& shot, const Answer& answer,
                         std::span<const uint> offered);

// A changed scene with its rays, and how its answers map back to the original scene: ids and t. Facing, barycentrics
// and the object's ray are not mapped back.
struct Changed {
    SceneInput scene;
    std::vector<Shot> shots;
    std::function<void(Answer&)> bring_back = [](Answer&) {};
};

// Coordinates are multiples of 2^-10 of some units (Draws), so that all of these are exact.
Changed translated(const SceneInput& scene, std::span<const Shot> shots, vec3 offset);
Changed turned(const SceneInput& scene, std::span<const Shot> shots, int axis);  // by 90 degrees
Changed scaled(const SceneInput& scene, std::span<const Shot> shots, float power_of_two);
Changed faster(const SceneInput& scene, std::span<const Shot> shots, float power_of_two);  // directions
// Triangle order[i] of the first geometry becomes triangle i.
Changed permuted(const SceneInput& scene, std::span<const Shot> shots, std::span<const uint> order);
// Splits the first geometry before triangle `at` into two geometries, or into two bottom levels in two instances.
Changed split_geometry(const SceneInput& scene, std::span<const Shot> shots, uint at);
Changed split_instance(const SceneInput& scene, std::span<const Shot> shots, uint at);
// Moves vertices by the inverse, and instances back again.
Changed by_instance(const SceneInput& scene, std::span<const Shot> shots, vec3 offset, float power_of_two);
// Returns the ray from its end at `t` back to its origin.
Shot reversed(const Shot& shot, float t);

// Compares two answers to a shot. They may name different triangles where rounding decides: at an edge, a tie, an end
// of the interval.
Finding compare_hits(const Expectation& expectation, const Shot& shot, const Answer& first, const Answer& second);
// Compares two lists of candidates in any order. A candidate that only one of them has must be uncertain.
Finding compare_candidates(const Expectation& expectation, const Shot& shot, std::span<const uint> first,
                           std::span<const uint> second);

}  // namespace twinray::conformance
