// SPDX-License-Identifier: MIT
// All hits of rays, and geometric queries that trace none: collisions of instances and of triangles, closest points,
// distances and winding numbers. All work is done on the GPU; the latter queries use a tree of boxes in Hilbert order.
//
// - Vertices are computed in float64 from float32 positions p and rows r of a transform by ((r.x p.x + r.y p.y) + r.z
//   p.z) + r.w, each sum rounded to nearest.
// - For these vertices, classes of pairs and winding numbers are exact: where float64 is not certain of a sign, the
//   host computes it by expansions (Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
//   Predicates", 1997).
// - Triangles of any shape count: one without area is the segment or the point that it covers. Those with a vertex that
//   is not finite are ignored.
// - Each call submits and waits. Wrong input and failures of the device throw Error naming the object, the value and
//   the limit.
// - Contexts and accelerators must outlive the objects made with them; memory is kept for the next call; an object is
//   used by one thread at a time.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <twinray/abstract_accel.h>
#include <twinray/scene.h>

namespace twinray {

// The number of pairs that a search may find before it throws, unless set otherwise.
inline constexpr std::uint64_t default_max_pairs = 1u << 27;

// All hits of rays ----------------------------------------------------------------------------------------------------

// The hits of all rays in one array.
struct HitsOfRays {
    std::vector<std::uint64_t> first;  // index of each ray's first hit, and at the end the number of all hits
    std::vector<Hit> hits;             // ascending by t for each ray, then by (instance, primitive)

    // Returns the hits of one ray.
    std::span<const Hit> of(std::size_t ray) const {
        return std::span(hits).subspan(first[ray], first[ray + 1] - first[ray]);
    }
};

// Finds every triangle that rays meet, each once, at level watertight: a closed surface is hit as often from outside as
// from inside, and of the triangles around an edge or a corner SwTlas reports exactly one per crossing. No filters
// are called: non-opaque triangles count. Uses mask and cull of TraceDesc. Each call syncs the accelerator.
class AllHits {
  public:
    // Throws Error if kernels cannot trace the accelerator (Feature::kernel_queries).
    explicit AllHits(AbstractAccel& accel);
    ~AllHits();

    // Throws Error for a scene with boxes, and if there are more than max_hits() hits, naming their number.
    HitsOfRays operator()(std::span<const Ray> rays, const TraceDesc& desc = {});

    // Returns the limit on hits, which take 36 bytes of device memory each. Default: 2^27; at most 2^32 - 1.
    std::uint64_t max_hits() const;
    void set_max_hits(std::uint64_t count);  // for the calls to come

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Broad phase: instances whose boxes overlap --------------------------------------------------------------------------

// Two instances by Hit::instance_index, the position among all instances of their accelerator.
struct InstancePair {
    uint a = 0;
    uint b = 0;

    auto operator<=>(const InstancePair&) const = default;
};

// Pairs in device memory: element i of both arrays of uint. Valid until the next call that finds some.
struct DevicePairs {
    std::uint64_t first = 0, second = 0;  // device addresses
    std::uint64_t count = 0;
    const Buffer* buffer = nullptr;  // holds both arrays; null if there are no pairs
};

// Finds instances whose boxes in world space overlap: the box of each geometry's active triangles (or boxes) under the
// transform, rounded outward, so that no contact of hittable geometry is lost. Boxes are closed: those that touch
// overlap. Instances that cannot be hit, with an empty geometry or an unusable transform, have no box. Works for every
// accelerator and brings it up to date in each call (AbstractAccel::sync). Throws Error for a dead handle, another
// context, and more than max_pairs() pairs, naming their number.
class BroadPhase {
  public:
    explicit BroadPhase(Context& context);  // keeps memory between calls
    ~BroadPhase();

    // Returns all pairs, also within one handle, each once: a < b, ascending.
    std::vector<InstancePair> instance_pairs(AbstractAccel& accel);
    // Returns pairs of an instance of handle `a` and one of handle `b`, in this order, ascending; if the handles are
    // the same, pairs within it as above.
    std::vector<InstancePair> instance_pairs(AbstractAccel& accel, AccelHandle a, AccelHandle b);
    // Returns pairs of an instance of one accelerator and one of the other, ascending. The accelerators must differ.
    std::vector<InstancePair> instance_pairs(AbstractAccel& a, AbstractAccel& b);

    // Return the number of pairs, without memory for them and without limit.
    std::uint64_t count(AbstractAccel& accel);
    std::uint64_t count(AbstractAccel& accel, AccelHandle a, AccelHandle b);
    std::uint64_t count(AbstractAccel& a, AbstractAccel& b);

    // Return whether there is a pair: they end soon after the first.
    bool any(AbstractAccel& accel);
    bool any(AbstractAccel& accel, AccelHandle a, AccelHandle b);
    bool any(AbstractAccel& a, AbstractAccel& b);

    // The same as the first function for kernels: valid until the next call.
    DevicePairs instance_pairs_on_device(AbstractAccel& accel);

    // Returns the limit on pairs. A pair takes 8 bytes of device memory, and 16 while they are sorted.
    std::uint64_t max_pairs() const;
    void set_max_pairs(std::uint64_t count);  // at most 2^32 - 1
    std::uint64_t bytes() const;              // device memory that is kept

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Narrow phase: triangles that touch or cross -------------------------------------------------------------------------

// The relation of two triangles as closed sets of points. It does not depend on the order of the triangles or of their
// vertices. "Inside" excludes edges and vertices; for a segment, its ends.
enum class PairClass : std::uint8_t {
    separate = 0,          // no common point
    vertex_touch = 1,      // one common point, an end or vertex of at least one, and not inside of both
    edge_touch = 2,        // more than that, but the insides have no common point
    coplanar_touch = 3,    // all six vertices in one plane: common points, but no common area
    coplanar_overlap = 4,  // likewise: a common area
    crossing = 5,          // not all six in one plane, and the insides have a common point
};
inline constexpr std::array all_pair_classes = {PairClass::separate,         PairClass::vertex_touch,
                                                PairClass::edge_touch,       PairClass::coplanar_touch,
                                                PairClass::coplanar_overlap, PairClass::crossing};

// Returns the spelling of `twinray collide`.
constexpr std::string_view name_of(PairClass pair_class) {
    constexpr std::string_view names[] = {"separate",       "vertex_touch",     "edge_touch",
                                          "coplanar_touch", "coplanar_overlap", "crossing"};
    return names[static_cast<std::size_t>(pair_class)];
}

// The vertices of a triangle in world space.
struct WorldTriangle {
    dvec3 a, b, c;
};

// Two triangles to classify.
struct TrianglePair {
    WorldTriangle a, b;
};

// Two triangles that have a point in common: instance_a < instance_b, or in one instance, triangle_a < triangle_b.
struct TriangleContact {
    uint instance_a = 0, instance_b = 0;
    uint triangle_a = 0, triangle_b = 0;
    PairClass pair_class = PairClass::separate;

    auto operator<=>(const TriangleContact&) const = default;
};

// The segment in which the insides of two triangles of class crossing meet. Its ends are equal if a triangle without
// area stands for a segment. Coordinates are off by at most 2^-49 of the largest coordinate of a vertex in magnitude.
struct ContactSegment {
    dvec3 from, to;
};

// How vertices of a mesh are identified, so that triangles that share them are neighbours.
enum class SharedVertices : std::uint8_t { by_index, by_position };

// Options of NarrowPhase::find().
struct ContactOptions {
    // Also reports pairs within an instance, except those that have only shared vertices and the edge between two of
    // them in common. Neighbours that are folded onto each other overlap.
    bool self = false;
    SharedVertices shared = SharedVertices::by_index;
    bool segments = false;  // for pairs of class crossing
};

// The result of NarrowPhase::find().
struct Contacts {
    std::vector<TriangleContact> list;     // ascending
    std::vector<ContactSegment> segments;  // by contact; (0, 0, 0) unless of class crossing; empty unless asked for
    std::uint64_t instances = 0;           // those whose boxes overlap others, or all if pairs within them count
    std::uint64_t triangles = 0;           // triangles of those instances
    std::uint64_t candidates = 0;          // pairs of triangles whose boxes overlap
    std::uint64_t host_decided = 0;        // candidates that float64 could not decide
    double search_seconds = 0, classify_seconds = 0, host_seconds = 0;  // the last is part of the one before

    std::size_t count(PairClass pair_class) const;  // of the list
};

// Finds all pairs of triangles of different instances that touch or intersect, and how, exactly.
class NarrowPhase {
  public:
    // Throws Error where the device has no float64.
    explicit NarrowPhase(Context& context);
    ~NarrowPhase();

    // Throws Error naming the fault of a mesh or an instance, or the number of overlapping pairs of boxes if that
    // exceeds max_pairs().
    Contacts find(const Scene& scene, const ContactOptions& options = {});
    Contacts find(AbstractAccel& accel, const ContactOptions& options = {});  // for its contents: see scene_of()
    // The same for meshes as instances place them.
    Contacts find(std::span<const MeshView> meshes, std::span<const MeshInstance> instances,
                  const ContactOptions& options = {});
    // Returns the class of each given pair. Throws Error for a coordinate that is neither 0 nor of a magnitude from
    // 2^-245 to 2^259.
    std::vector<PairClass> classify(std::span<const TrianglePair> pairs);

    // Returns the limit on pairs of boxes, of instances and of triangles. At most 2^32 - 1.
    std::uint64_t max_pairs() const;
    // Applies to later calls.
    void set_max_pairs(std::uint64_t count);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Points --------------------------------------------------------------------------------------------------------------

// The point of a scene that is closest to a given one.
struct ClosestPoint {
    dvec3 position = dvec3(0);  // on the triangle, in world space
    double distance = std::numeric_limits<double>::infinity();
    double u = 0, v = 0;  // barycentric coordinates: (1 - u - v) a + u b + v c
    bool is_found = false;
    uint instance = 0, triangle = 0;
};

// A triangle that is near to a given point, by the index of the point.
struct NearTriangle {
    uint point = 0;
    uint instance = 0, triangle = 0;
    double distance = 0;
};

// Finds triangles of a scene that are near to points. A distance is off by at most some 2^-50 of the largest of itself
// and the sides of the triangle; boxes bound it, so that none is passed over. Points that are not finite are near none.
class PointQuery {
  public:
    static constexpr double unlimited = std::numeric_limits<double>::infinity();

    // Throws Error if the device has no float64.
    explicit PointQuery(Context& context);
    ~PointQuery();

    // Sets the scene to search from now on: builds a tree. The data that the spans refer to must outlive this object.
    // Throws Error naming the fault of a mesh or an instance.
    void set(const Scene& scene);
    // Takes what the accelerator holds now: see scene_of(). It may change or end.
    void set(AbstractAccel& accel);
    void set(std::span<const MeshView> meshes, std::span<const MeshInstance> instances);
    std::size_t triangle_count() const;  // the triangles that are searched

    // Returns for each point the closest triangle that is at most `max_distance` away; among several, the first by
    // (instance, triangle). Throws Error for a distance below 0 or NaN.
    std::vector<ClosestPoint> closest(std::span<const dvec3> points, double max_distance = unlimited);
    // Returns all triangles that are at most `radius` from a point, ascending by (point, instance, triangle). Throws
    // Error for a radius that is below 0 or not finite, and if there are more than max_found(), naming their number.
    std::vector<NearTriangle> within(std::span<const dvec3> points, double radius);

    // Returns how often the scene winds around each point (Jacobson et al. 2013, here counted along a ray with
    // simulation of simplicity). The number is exact: 0 outside and 1 inside a closed mesh whose fronts look outward, n
    // inside n that overlap; a mirrored instance counts as its mesh does. For a point on a triangle it may be that of
    // either side. Throws Error naming a mesh that is not closed and one of its edges that lack a neighbour, for points
    // with a coordinate that is neither 0 nor of a magnitude from 2^-245 to 2^259, and if more crossings are undecided
    // than max_found().
    std::vector<int> winding_numbers(std::span<const dvec3> points);
    // The same for any scene, closed or not (Jacobson et al. 2013): the solid angle of all triangles over 4 pi, between
    // whole numbers near holes. Off by some 2^-50 times the number of edges without a neighbour, and time grows with
    // that number: crossings of a line, exactly, and what the boundary adds (Martens, Trettner, Bessmeltsev 2026).
    std::vector<double> generalized_winding_numbers(std::span<const dvec3> points);
    // Returns whether all meshes are closed, so that there are winding numbers.
    bool is_closed();
    // Returns the distance of closest(), negative if the winding number is not 0.
    std::vector<double> signed_distances(std::span<const dvec3> points);
    // Returns the number of crossings of the last winding numbers that float64 could not decide, so that the host did.
    std::uint64_t host_decided() const;

    // Returns the limit on finds per call of within(), 16 bytes of device memory each. Default: 2^27; at most 2^32 - 1.
    std::uint64_t max_found() const;
    void set_max_found(std::uint64_t count);  // for the calls to come
    std::uint64_t bytes() const;              // device memory that is kept

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace twinray
