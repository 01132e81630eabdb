// The reference: closest and any hits of a scene in float64 on the CPU, independent of both accelerators.
#pragma once

#include <twinray/scene.h>

#include "engine/accel/geometry.h"
#include "engine/core/ray.h"
#include "validation/reference/geometry64.h"
#include <twinray/validation.h>

namespace twinray {

// The hits that a query skips, in the terms of TraceDesc.
struct ReferenceQuery {
    std::uint8_t mask = 0xff;  // instances whose mask shares no bit with it are not hit
    uint flags = 0;            // CULL_BACK or CULL_FRONT: triangles that show that side are not hit
};

// An affine map in float64 and its inverse.
struct Placement64 {
    glm::dmat3 to_world{1.0}, to_object{1.0};  // linear parts
    dvec3 offset{0.0};                         // of to_world
    bool is_identity = true;
    double condition = 1;  // infinity norm of |to_object| |to_world|: how much the inverse amplifies rounding

    Placement64() = default;
    // Throws Error, naming `object`, when an entry is not finite or the linear part is singular.
    Placement64(const Transform& transform, const char* object);

    dvec3 point_to_object(const dvec3& p) const { return is_identity ? p : to_object * (p - offset); }
    dvec3 vector_to_object(const dvec3& v) const { return is_identity ? v : to_object * v; }
};

// Returns |m| |v|.
inline dvec3 absolute_product(const glm::dmat3& m, const dvec3& v) {
    return abs(m[0]) * std::abs(v.x) + abs(m[1]) * std::abs(v.y) + abs(m[2]) * std::abs(v.z);
}

// Answers by the rules of twinray/glsl/ray.h and docs/architecture.md, "Rules of a hit": t_min < t < t_max, both
// exclusive; a negative t_min counts as 0; rays that are not is_traceable() miss; triangles that are not finite or have
// no area are never hit, nor is what the query leaves out; the closest hit has the smallest t, then the lowest
// (instance, primitive). Immutable, so threads may share it.
class ReferenceScene {
  public:
    // Copies what it needs. Throws Error on an index out of range and on a singular or non-finite transform.
    ReferenceScene(std::span<const MeshView> geometries, std::span<const ReferenceInstance> instances);
    // Shares geometries that are built already; none may be null.
    ReferenceScene(std::vector<std::shared_ptr<const Geometry64>> geometries,
                   std::span<const ReferenceInstance> instances);
    static ReferenceScene of(const Scene& scene);

    ReferenceHit closest_hit(const Ray& ray, const ReferenceQuery& query = {}) const;
    // Finds the same answer, bit for bit, by testing every triangle.
    ReferenceHit closest_hit_brute_force(const Ray& ray, const ReferenceQuery& query = {}) const;
    bool any_hit(const Ray& ray, const ReferenceQuery& query = {}) const;

    // Returns the instances, whatever their masks, that the ray hits at some t with t_min < t < t_limit, ascending.
    std::vector<uint> instances_hit(const Ray& ray, double t_limit) const;

    // Returns the instances, whatever their masks, that the ray may meet at some t with t_min < t < t_max, or passes
    // within float64's rounding, ascending.
    std::vector<uint> instances_near(const Ray& ray) const;

    const Box64& bounds() const { return bvh_.bounds(); }  // of the active triangles in world space
    uint instance_count() const { return static_cast<uint>(instances_.size()); }
    const Geometry64& geometry(uint instance) const { return *geometries_[instances_[instance].geometry]; }
    const Placement64& placement(uint instance) const { return instances_[instance].placement; }
    const InstanceOptions& options(uint instance) const { return instances_[instance].options; }

  private:
    struct PlacedGeometry {
        uint geometry = 0;
        InstanceOptions options;
        Placement64 placement;
        Box64 world_box;  // empty when the geometry has no active triangle
    };
    struct Search;

    template <bool BRUTE_FORCE>
    void search_instance(uint instance, Search& search) const;
    void search_all(Search& search) const;

    std::vector<std::shared_ptr<const Geometry64>> geometries_;
    std::vector<PlacedGeometry> instances_;
    std::vector<uint> placed_;  // instances with an active triangle: what the items of bvh_ are
    Bvh64 bvh_;
    double condition_ = 1;  // the worst of all placements
};

}  // namespace twinray
