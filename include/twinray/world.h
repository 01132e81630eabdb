// SPDX-License-Identifier: MIT
// World coordinates in float64, for scenes that are far larger than float32 resolves, such as maps in metres.
//
//     WorldAccel world(accel, dvec3(500000, 5400000, 100));   // the zero of float32 coordinates
//     AccelHandle house = world.push(mesh, Transform64::translation({500012.13, 5400003.27, 101.5}));
//     std::vector<Hit> hits = world.closest_hits(rays);       // of Ray64
//     world.set_origin(camera);                               // views stay valid: only the top level is refitted
#pragma once

#include <unordered_map>

#include <twinray/abstract_accel.h>

namespace twinray {

// Like Transform, in float64.
struct Transform64 {
    std::array<dvec4, 3> rows = {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0)};

    Transform64() = default;
    Transform64(const Transform& transform);       // widened exactly
    static Transform64 translation(dvec3 offset);  // moves by it
};

// A mesh whose vertices are in float64, not owned. It is built about a point of its own, so that its triangles keep
// their shape at any distance from the origin.
struct MeshView64 {
    std::string_view name;
    std::span<const dvec3> positions;
    std::span<const uvec3> triangles;
};

// If a ray begins so far from the box that float32 would round its line by more than a millionth of the box, moves its
// origin along that line, in float64, near to the box. Returns the moved part of t; 0: it began near enough.
double bring_near(Ray64& ray, const Bounds& box);

// An accelerator whose instances are placed in float64. It traces in float32 relative to an origin, so that t of rays
// that begin near the origin is right to 2 units in the last place of the size of the scene around it. Objects pushed
// through it must be moved and erased through it; everything else of the accelerator (view(), trace(), surfaces(),
// other meshes by update()) uses coordinates about the origin, and for a MeshView64 about the middle of its box.
class WorldAccel {
  public:
    // The accelerator must outlive it. Throws Error for an origin that is not finite.
    explicit WorldAccel(AbstractAccel& accel, dvec3 origin = {});

    // See AbstractAccel::push.
    AccelHandle push(const MeshView& mesh, const Transform64& transform = {}, const InstanceOptions& options = {});
    AccelHandle push(const MeshView& mesh, std::span<const Transform64> transforms,
                     std::span<const InstanceOptions> options = {});
    AccelHandle push(const MeshView64& mesh, const Transform64& transform = {}, const InstanceOptions& options = {});
    AccelHandle push(const DeviceMesh& mesh, std::span<const Transform64> transforms,
                     std::span<const InstanceOptions> options = {});
    bool erase(AccelHandle handle);  // see AbstractAccel::erase
    // See AbstractAccel::update_transforms.
    void update_transforms(AccelHandle handle, std::span<const Transform64> transforms);

    // Sets the origin and moves every instance to match; the next sync refits the top level and no geometry.
    void set_origin(dvec3 origin);
    dvec3 origin() const { return origin_; }  // the point that coordinates are relative to

    // Converts from world coordinates to coordinates about the origin, rounded once.
    vec3 local(dvec3 position) const;
    Ray local(const Ray64& ray) const;
    dvec3 world(dvec3 position) const;  // the inverse
    // See AbstractAccel. Rays that begin far from the scene are moved near it; t counts from their given origins.
    std::vector<Hit> closest_hits(std::span<const Ray64> rays, const TraceDesc& desc = {});
    // The same for any hit instead of the closest.
    std::vector<Hit> any_hits(std::span<const Ray64> rays, const TraceDesc& desc = {});
    // The same for AbstractAccel::exact_hits.
    std::vector<HitExact> exact_hits(std::span<const Ray64> rays, const TraceDesc& desc = {});

    AbstractAccel& accel() { return accel_; }  // the one that it was made with

  private:
    struct Placed {
        dvec3 center;  // the point that the mesh's vertices are relative to
        std::vector<Transform64> transforms;
    };
    std::vector<Transform> local(const Placed& placed, const dvec3& origin) const;
    template <class Mesh>
    AccelHandle place(const Mesh& mesh, Placed&& placed, std::span<const InstanceOptions> options);
    std::vector<Hit> trace(std::span<const Ray64> rays, const TraceDesc& desc, Query query);

    AbstractAccel& accel_;
    dvec3 origin_;
    std::unordered_map<std::uint64_t, Placed> placed_;
};

}  // namespace twinray
