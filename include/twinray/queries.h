// SPDX-License-Identifier: MIT
// All hits of rays, and geometric queries that trace none: collisions of instances and of triangles, closest points,
// distances and winding numbers. All work is done on the GPU, of the latter over a tree of boxes in Hilbert order.
//
// - Vertices are where float64 puts them: from float32 positions p and rows r of a transform by
//   ((r.x p.x + r.y p.y) + r.z p.z) + r.w, each sum rounded to nearest.
// - Of these, classes of pairs and winding numbers are exact: where float64 is not certain of a sign, the host computes
//   it by expansions (Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates",
//   1997).
// - Triangles count whatever their shape: one without area is the segment or the point that it covers. Those with a
//   vertex that is not finite take no part.
// - Each call submits and waits. It throws Error, which names what, the value and the limit, for wrong input and
//   failures of the device.
// - Contexts and accelerators must outlive what was made with them; memory is kept for the next call; an object is used
//   by one thread at a time.
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

// A mesh where an instance puts it.
struct MeshInstance {
    uint mesh = 0;  // index among the meshes
    Transform transform;
};

// How many pairs a search may find before it throws, unless told otherwise.
inline constexpr std::uint64_t default_max_pairs = 1u << 27;

// All hits of rays ----------------------------------------------------------------------------------------------------

// Hits by ray, those of all rays in one array.
struct HitsOfRays {
    std::vector<std::uint64_t> first;  // of each ray's hits, and at the end how many there are in all
    std::vector<Hit> hits;             // of each ray ascending by t, then by (instance, primitive)

    // The hits of one ray.
    std::span<const Hit> of(std::size_t ray) const {
        return std::span(hits).subspan(first[ray], first[ray + 1] - first[ray]);
    }
};

// Finds every triangle that rays meet, each once, at level watertight: a closed surface is met as often from outside as
// from inside, and of the triangles around an edge or a corner SwTlas names exactly one a crossing. Filters of
// instances are not asked: what is non-opaque counts. Uses mask and cull of TraceDesc. Each call syncs the accelerator.
class AllHits {
  public:
    // Throws Error where kernels cannot trace the accelerator (Feature::kernel_queries).
    explicit AllHits(AbstractAccel& accel);
    ~AllHits();

    // Throws Error for a scene with boxes, and one that says how many hits there are where they exceed max_hits().
    HitsOfRays operator()(std::span<const Ray> rays, const TraceDesc& desc = {});

    // 36 bytes of device memory each. Default: 2^27; at most 2^32 - 1.
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
    const Buffer* buffer = nullptr;  // that holds both; null where there are none
};

// Finds instances whose boxes in world space overlap: the box of each geometry's active triangles (or boxes) under the
// transform, rounded outward, so that no contact of what can be hit is lost. Boxes are closed: those that touch
// overlap. Instances that cannot be hit, with an empty geometry or an unusable transform, have no box. Works alike for
// every accelerator, which each call brings up to date (AbstractAccel::sync). Throws Error for a dead handle, another
// context, and the count where more than max_pairs() are found.
class BroadPhase {
  public:
    explicit BroadPhase(Context& context);  // keeps memory between calls
    ~BroadPhase();

    // All pairs, also within one handle, each once: a < b, ascending.
    std::vector<InstancePair> instance_pairs(AbstractAccel& accel);
    // Pairs of an instance of handle `a` and one of handle `b`, in this order, ascending; within the handle, as above,
    // where they are the same.
    std::vector<InstancePair> instance_pairs(AbstractAccel& accel, AccelHandle a, AccelHandle b);
    // Pairs of an instance of one accelerator and one of the other, ascending. Two accelerators, not one twice.
    std::vector<InstancePair> instance_pairs(AbstractAccel& a, AbstractAccel& b);

    // How many there are, without memory for them and without limit.
    std::uint64_t count(AbstractAccel& accel);
    std::uint64_t count(AbstractAccel& accel, AccelHandle a, AccelHandle b);
    std::uint64_t count(AbstractAccel& a, AbstractAccel& b);

    // Whether there is a pair: ends soon after the first.
    bool any(AbstractAccel& accel);
    bool any(AbstractAccel& accel, AccelHandle a, AccelHandle b);
    bool any(AbstractAccel& a, AbstractAccel& b);

    // The same as the first function, for kernels: valid until the next call.
    DevicePairs instance_pairs_on_device(AbstractAccel& accel);

    // A pair takes 8 bytes of device memory, and 16 while they are sorted.
    std::uint64_t max_pairs() const;
    void set_max_pairs(std::uint64_t count);  // at most 2^32 - 1
    std::uint64_t bytes() const;              // of device memory that is kept

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Narrow phase: triangles that touch or cross -------------------------------------------------------------------------

// How two triangles lie to each other, as closed sets of points. Does not depend on the order of the triangles or of
// their vertices. "Inside" is without edges and vertices; of a segment, without its ends.
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

// As `twinray collide` writes it.
constexpr std::string_view name_of(PairClass pair_class) {
    constexpr std::string_view names[] = {"separate",       "vertex_touch",     "edge_touch",
                                          "coplanar_touch", "coplanar_overlap", "crossing"};
    return names[static_cast<std::size_t>(pair_class)];
}

// The vertices of a triangle in world space.
struct WorldTriangle {
    dvec3 a, b, c;
};

// Two triangles whose class is asked for.
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

// Where the insides of two triangles of class crossing meet: the two ends of it, which are one where a triangle without
// area stands for a segment. Coordinates are off by at most 2^-49 of the largest coordinate of a vertex in magnitude.
struct ContactSegment {
    dvec3 from, to;
};

// Which vertices of a mesh are one, so that triangles that have them are neighbours.
enum class SharedVertices : std::uint8_t { by_index, by_position };

// What NarrowPhase::find() looks for.
struct ContactOptions {
    // Also pairs within an instance, but for those that have no more in common than vertices that they share and the
    // edge between two of them. Pairs of its neighbours that are folded onto each other overlap.
    bool self = false;
    SharedVertices shared = SharedVertices::by_index;
    bool segments = false;  // of pairs of class crossing
};

// What NarrowPhase::find() found.
struct Contacts {
    std::vector<TriangleContact> list;     // ascending
    std::vector<ContactSegment> segments;  // by contact, of class crossing, others (0, 0, 0); empty unless asked for
    std::uint64_t instances = 0;           // whose boxes overlap others, or all where pairs within them count
    std::uint64_t triangles = 0;           // of them
    std::uint64_t candidates = 0;          // pairs of triangles whose boxes overlap
    std::uint64_t host_decided = 0;        // of those, undecided by float64
    double search_seconds = 0, classify_seconds = 0, host_seconds = 0;  // the last is part of the one before

    std::size_t count(PairClass pair_class) const;  // of the list
};

// Finds all pairs of triangles of different instances that touch or intersect, and how, exactly.
class NarrowPhase {
  public:
    // Throws Error where the device has no float64.
    explicit NarrowPhase(Context& context);
    ~NarrowPhase();

    // Throws Error naming what is wrong with a mesh or an instance, or the number of pairs of boxes that overlap where
    // that exceeds max_pairs().
    Contacts find(const Scene& scene, const ContactOptions& options = {});
    Contacts find(AbstractAccel& accel, const ContactOptions& options = {});  // of what it holds: see scene_of()
    // Of meshes where instances put them.
    Contacts find(std::span<const MeshView> meshes, std::span<const MeshInstance> instances,
                  const ContactOptions& options = {});
    // The class of each pair given. Throws Error for a coordinate that is neither 0 nor of a magnitude from 2^-245 to
    // 2^259.
    std::vector<PairClass> classify(std::span<const TrianglePair> pairs);

    // Of boxes, of instances and of triangles. At most 2^32 - 1.
    std::uint64_t max_pairs() const;
    // For the calls to come.
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

// Finds what of a scene is near to points. A distance is off by at most some 2^-50 of the largest of itself and the
// sides of the triangle; boxes are bounds of it, so that none is passed over. No point that is not finite is near.
class PointQuery {
  public:
    static constexpr double unlimited = std::numeric_limits<double>::infinity();

    // Throws Error where the device has no float64.
    explicit PointQuery(Context& context);
    ~PointQuery();

    // What is searched from now on: builds a tree. What the spans refer to must outlive the use of this. Throws Error
    // naming what is wrong with a mesh or an instance.
    void set(const Scene& scene);
    // What the accelerator holds now: see scene_of(). It may change or end.
    void set(AbstractAccel& accel);
    void set(std::span<const MeshView> meshes, std::span<const MeshInstance> instances);
    std::size_t triangle_count() const;  // of what is searched

    // Of each point, the closest triangle that is at most `max_distance` away: of several, the first by (instance,
    // triangle). Throws Error for a distance below 0 or NaN.
    std::vector<ClosestPoint> closest(std::span<const dvec3> points, double max_distance = unlimited);
    // All triangles that are at most `radius` from a point, ascending by (point, instance, triangle). Throws Error for
    // a radius that is below 0 or not finite, and one that says how many there are where they exceed max_found().
    std::vector<NearTriangle> within(std::span<const dvec3> points, double radius);

    // How often the scene winds around each point (Jacobson et al. 2013, here counted along a ray with simulation of
    // simplicity): exactly, 0 outside and 1 inside of a closed mesh whose fronts look outward, n inside of n that
    // overlap; a mirrored instance counts as its mesh does. Of points on a triangle it may be either side's. Throws
    // Error naming a mesh that is not closed and one of its edges that lack a neighbour, for points with a coordinate
    // that is neither 0 nor of a magnitude from 2^-245 to 2^259, and where more crossings are undecided than
    // max_found().
    std::vector<int> winding_numbers(std::span<const dvec3> points);
    // The same of any scene, closed or not (Jacobson et al. 2013): the solid angle of all triangles over 4 pi, between
    // whole numbers near holes. Off by some 2^-50 times the number of edges without a neighbour, and time grows with
    // that number: crossings of a line, exactly, and what the boundary adds (Martens, Trettner, Bessmeltsev 2026).
    std::vector<double> generalized_winding_numbers(std::span<const dvec3> points);
    // Whether all meshes are closed, so that there are winding numbers.
    bool is_closed();
    // The distance of closest(), negative where the winding number is not 0.
    std::vector<double> signed_distances(std::span<const dvec3> points);
    // Of the last winding numbers: how many crossings float64 could not decide, and the host did.
    std::uint64_t host_decided() const;

    // Of all that a call of within() finds, 16 bytes of device memory each. Default: 2^27; at most 2^32 - 1.
    std::uint64_t max_found() const;
    void set_max_found(std::uint64_t count);  // for the calls to come
    std::uint64_t bytes() const;              // of device memory that is kept

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace twinray
