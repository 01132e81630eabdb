// SPDX-License-Identifier: MIT
// What of a scene is near to points: closest points, signed distances, winding numbers, all within a distance.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <twinray/scene.h>

#include "engine/collide/box_tree.h"
#include "engine/collide/triangle_set.h"
#include "engine/core/pace.h"

namespace twinray {
#include "engine/core/bridge_begin.h"
#include "shaders/shared/point_search.h"
#include "engine/core/bridge_end.h"

static_assert(sizeof(QueryPoint) == 24 && sizeof(NearestPoint) == 56 && sizeof(PointItem) == 16);

struct ClosestPoint {
    dvec3 position = dvec3(0);  // on the triangle, in world space
    double distance = std::numeric_limits<double>::infinity();
    dvec2 uv = dvec2(0);  // barycentric coordinates: (1 - u - v) a + u b + v c
    bool is_found = false;
    uint instance = 0, triangle = 0;
};

struct NearTriangle {
    uint point = 0;
    uint instance = 0, triangle = 0;
    double distance = 0;
};

// Finds what of a scene is near to points, by a tree of boxes around its triangles in world space. Corners are those of
// shaders/shared/world_corner.h. All is computed in float64, and a distance is off by at most some 2^-50 of the largest
// of itself and the sides of the triangle; boxes are bounds of it, so that none is passed over. Points that are not
// finite are near to nothing. Triangles count whatever their shape, as the segment or the point that they cover; those
// with a corner that is not finite do not.
//
// Each call submits and waits. Memory is kept for the next one.
class PointFinder {
  public:
    static constexpr double unlimited = std::numeric_limits<double>::infinity();

    // Throws Error where the device has no float64.
    explicit PointFinder(Context& context);

    // What is searched from now on: a tree is built on the GPU. What the spans refer to must outlive the use of this.
    // Throws Error naming what is wrong with a mesh or an instance.
    void set(const Scene& scene);
    void set(std::span<const MeshView> meshes, std::span<const MeshInstance> instances);
    std::size_t triangle_count() const { return triangles_.count(); }

    // Of each point, the nearest triangle that is at most `max_distance` away: of several, the first by (instance,
    // triangle). Throws Error for a distance below 0 or NaN.
    std::vector<ClosestPoint> closest(std::span<const dvec3> points, double max_distance = unlimited);
    // All triangles that are at most `radius` from a point, ascending by (point, instance, triangle). Throws Error for
    // a radius that is below 0 or not finite, and one that says how many there are where they exceed max_found().
    std::vector<NearTriangle> within(std::span<const dvec3> points, double radius);

    // How often the scene winds around each point: exactly, 0 outside and 1 inside of a closed mesh whose fronts look
    // outward, n inside of n that overlap; a mirrored instance counts as its mesh does. Of points on a triangle it may
    // be either side's. Throws Error naming a mesh that is not closed (see find_boundary_edge) and one of its edges,
    // for points with a coordinate that is neither 0 nor of a magnitude from 2^-245 to 2^259, and where more crossings
    // are undecided than max_found().
    std::vector<int> winding_numbers(std::span<const dvec3> points);
    // The distance of closest(), negative where the winding number is not 0.
    std::vector<double> signed_distances(std::span<const dvec3> points);
    // Of the last winding numbers: how many crossings float64 could not decide, and the host did.
    std::uint64_t host_decided() const { return host_decided_; }

    // Of all that a call of within() finds, 16 bytes of device memory each. Default: 2^27; at most 2^32 - 1.
    std::uint64_t max_found() const { return found_.limit(); }
    void set_max_found(std::uint64_t count) { found_.set_limit(count); }
    std::uint64_t bytes() const;  // of device memory that is kept

  private:
    PointSearchArgs upload(std::span<const dvec3> points, std::uint64_t result_bytes);
    std::vector<PointItem> found(const Kernel<PointSearchArgs>& kernel, PointSearchArgs args);
    void check_closed();
    void wind(std::span<const dvec3> points, std::span<int> windings);

    Context& context_;
    Kernel<PointSearchArgs> boxes_of_points_, nearest_, within_, winding_;
    HilbertOrder order_;
    TriangleSet triangles_;
    BoxTree tree_;
    std::vector<MeshView> meshes_;
    std::vector<MeshInstance> instances_;
    std::optional<std::string> side_fault_;  // of the first mesh that is not closed; not set: not looked for yet
    float scale_ = 1;
    Buffer points_, point_boxes_, results_;
    DeviceList found_;
    Pace pace_;
    std::uint64_t host_decided_ = 0;
};

}  // namespace twinray
