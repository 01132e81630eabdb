// Bounds of what a kernel of given precision can tell about one ray and one triangle, and whether rounding can let a
// ray slip between the triangles of one instance.
#pragma once

#include "validation/reference/reference_scene.h"

namespace twinray {

// The one that rounds: the accelerators in float32, the reference in float64.
enum class Accelerator { software, hardware, reference };

// One triangle seen along a ray, in object units, float64. The ray is the point (0, 0).
struct TriangleBound {
    std::array<dvec2, 3> vertices;  // perpendicular to the ray
    double radius = 0;              // the kernel sees each vertex displaced by up to this
    double margin = 0;              // distance from the ray to the outline: positive inside, negative outside
    double t = 0;                   // where the ray meets the triangle's plane, in units of its direction
    double t_low = 0;               // a kernel that accepts the triangle finds a t in [t_low, t_high]
    double t_high = 0;
    double point_error = 0;  // how far from the ray the point of its u, v may lie

    // Returns the distance from the ray to the point (1-u-v) v0 + u v1 + v v2.
    double distance_to(double u, double v) const;
};

// The rays that a kernel may trace in place of the given one, in the object space of one instance.
//
// With unit roundoff e (2^-24 in float32), a kernel computes o' = W o + w with an error of at most 5e (|W||o| + |w|) (W
// rounded, three products, three sums), d' with 4e |W||d|, and shears a vertex v with 2e |v - o'| for the differences,
// 5e for Vulkan's 2.5 ulp division and 2e for product and sum, in each of two axes: together less than
// 16e (|v - o'| + |W||o| + |w| + |v - o'| |W||d| / |d'|). The hardware inverts the matrix itself, which scales the
// error of W by the condition number of the matrix; so does the reference, with e = 2^-53, for which 32e is taken,
// because the bound is itself computed in float64. An identity placement transforms without error. t follows pbrt-v4
// ("Bounding Intersection Point Error", 6.8.5): displaced vertices and rounded edge functions shift the weights, the
// more the thinner the triangle, and t with them, but never beyond the vertices' depths.
class ErrorBounds {
  public:
    ErrorBounds(const Ray& ray, const Placement64& placement, Accelerator accelerator);

    TriangleBound bound(const Triangle64& triangle) const;
    // Returns a radius that no triangle in the box exceeds.
    double max_radius(const Box64& box) const;
    // Returns a slab test against boxes grown by `pad`.
    SlabRay slabs(double pad) const { return {origin_, direction_, pad}; }

  private:
    struct Depths {
        std::array<double, 3> z;  // of the vertices along the ray, object units
        double low, high;         // of z, and of z as a shear along the longest axis measures it
    };
    double radius_at(double distance) const;
    void set_depth_bounds(TriangleBound& bound, const Depths& depths) const;

    double rounding_;  // 16e, or 32e
    bool has_accurate_weights_;
    dvec3 origin_, direction_;
    double length_;               // of direction_
    int longest_;                 // axis of direction_
    std::array<dvec3, 3> frame_;  // orthonormal, the last one along the ray
    double origin_error_ = 0;     // in units of rounding_
    double direction_error_ = 0;  // relative, in units of rounding_
};

struct PatchTriangle {
    std::array<vec3, 3> vertices;  // shared vertices are recognised by equal positions, as Vulkan does
    TriangleBound bound;
};

enum class Coverage {
    certain,     // however the vertices are displaced, the ray hits one of the triangles
    open,        // some ray within the radius misses them all: a silhouette or the rim of an open mesh
    unresolved,  // neither: only edges that meet without sharing their vertices close the way (T-junction,
                 // non-manifold edge)
};

// The patch must hold every triangle of one instance, in the wanted depth range, that comes within the
// largest radius of the ray. A triangle that contains the ray by more than its radius is certain. Otherwise:
// a kernel that treats a shared vertex alike in all its triangles sees a map of displaced vertices, each off by up
// to the radius. Take triangles that are joined along all edges near the ray, oriented alike. Their common boundary
// stays away from the ray under every such displacement, so the number of times they wind around the ray - the
// degree of the map - cannot change; if it is not 0, one of them contains the ray always.
Coverage coverage(std::span<const PatchTriangle> patch);

}  // namespace twinray
