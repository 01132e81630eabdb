// SPDX-License-Identifier: MIT
// Checks whether hits are right. A Reference traces rays in float64 on the CPU and gives every answer of an accelerator
// a class; a LeakTest needs no reference: a ray from inside a closed mesh must cross it an odd number of times.
//
//     Reference reference(scene);
//     const std::vector<Ray> rays = vertex_aimed_rays(reference, 100'000, seed);
//     const HitClassCounts counts = count(reference.classify(rays, accel.closest_hits(rays), TracedBy::software));
//     counts.faults_of_ours();  // 0 unless twinray has a fault
//     counts.bound_95();        // with 95 % confidence no more of such rays are faulty
//
// An answer is accepted if it is the exact answer to some ray within float32 rounding of the given one, so that a miss
// at the rim of an open mesh is no fault; a leak is reported only if no such ray exists.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <twinray/trace.h>

namespace twinray {

class AbstractAccel;
class Context;
class ReferenceScene;
struct Scene;

// The verdict on an answer.
enum class HitClass : std::uint8_t {
    agree,             // same hit or miss as the reference, t within its error bound
    tie,               // another primitive at the same t, within both error bounds
    boundary,          // rounding decides: a silhouette, a rim, a triangle that the ray passes within rounding
    boundary_hw_miss,  // the same, and hardware missed
    unspecified,       // Vulkan promises nothing: T-junction, or t at t_min, t_max or beyond float32
    invalid_input,     // hit reported for a ray that is not is_traceable()
    sw_leak,           // missed a hit that no rounding of the ray excuses, wholly or for one farther away
    sw_false,          // reported a triangle that the ray misses by more than rounding, or a t outside the interval
    t_err,             // SW reported the right triangle at a t, u or v beyond the error bound
    hw_leak,
    hw_false,
    hw_t_err,
    hw_range,  // not finite t, u or v, or u, v beyond the error bound: over- or underflow in the driver
};
inline constexpr std::size_t hit_class_count = 13;
std::string_view name_of(HitClass kind);   // "AGREE", "SW_LEAK", "T_ERR", ... as in reports
bool is_fault_of_ours(HitClass kind);      // sw_leak, sw_false, t_err: their count must be 0
bool is_fault_of_hardware(HitClass kind);  // hw_leak, hw_false, hw_t_err, hw_range: the driver's

// How often each class occurred.
struct HitClassCounts {
    std::array<std::uint64_t, hit_class_count> counts{};

    std::uint64_t operator[](HitClass kind) const { return counts[static_cast<std::size_t>(kind)]; }  // of one class
    void add(HitClass kind) { ++counts[static_cast<std::size_t>(kind)]; }                             // one more
    HitClassCounts& operator+=(const HitClassCounts& other);                                          // adds per class
    std::uint64_t total() const;                                                                      // of all classes
    std::uint64_t faults_of_ours() const;      // of those that is_fault_of_ours() names
    std::uint64_t faults_of_hardware() const;  // of those that is_fault_of_hardware() names
    // Returns an upper bound of the rate of faults (Clopper, Pearson 1934): 3 / total() if none was seen; 1 for no ray.
    double bound_95() const;
};
HitClassCounts count(std::span<const HitClass> classes);  // counts per class

// One instance of a mesh, in the order of the accelerator's instance array.
struct ReferenceInstance {
    uint geometry = 0;  // index into the meshes
    Transform object_to_world;
    InstanceOptions options = {};
};

// The reference's answer to a ray.
struct ReferenceHit {
    bool hit = false;
    double t = -1;        // in units of the ray's direction
    double u = 0, v = 0;  // the point is (1-u-v) v0 + u v1 + v v2
    uint primitive = 0, instance = 0, custom_index = 0;
    bool is_front = false;  // whether the front is met, by the rules of culling
    bool operator==(const ReferenceHit&) const = default;
};

// The rules that apply: SwTlas must be right wherever float32 can be; for a driver, a class states what it does.
enum class TracedBy : std::uint8_t { software, hardware };

// A scene in float64, built once on the CPU. Copies share it; threads may share it too.
class Reference {
  public:
    // Copies what it needs. Throws Error for an index out of range and for a singular or non-finite transform.
    explicit Reference(const Scene& scene);
    Reference(std::span<const MeshView> meshes, std::span<const ReferenceInstance> instances);

    // Finds the smallest t in (t_min, t_max), then the lowest (instance, primitive); rays not is_traceable() miss.
    ReferenceHit closest_hit(const Ray& ray) const;
    bool any_hit(const Ray& ray) const;  // whether anything is on the ray

    // Returns the class of a closest hit or a miss; Hit::custom_index and flags are not compared.
    HitClass classify(const Ray& ray, const Hit& hit, TracedBy by) const;
    // The same for all, on all cores. Throws Error unless there is one hit per ray.
    std::vector<HitClass> classify(std::span<const Ray> rays, std::span<const Hit> hits, TracedBy by) const;
    // The same for an any-hit query: compares only hit or miss.
    HitClass classify_any(const Ray& ray, bool is_hit, TracedBy by) const;

    const ReferenceScene& scene() const { return *scene_; }  // for twinray's own parts

  private:
    std::shared_ptr<const ReferenceScene> scene_;
};

// Makes the reference behind the interface of the accelerators, without boxes and filters. The host answers while a
// trace is recorded, so that sync(), the rays and an indirect count must be submitted before.
std::unique_ptr<AbstractAccel> make_reference_accel(Context& context);

// Make rays from everywhere around the scene in uniform directions, or aimed at random vertices or points of edges,
// where intersection tests break. Ray i depends only on (seed, i) and the scene; t_min = 0, t_max = infinity.
std::vector<Ray> random_rays(const Bounds& bounds, std::size_t count, std::uint64_t seed);
std::vector<Ray> vertex_aimed_rays(const Reference& reference, std::size_t count, std::uint64_t seed);  // at vertices
std::vector<Ray> edge_aimed_rays(const Reference& reference, std::size_t count, std::uint64_t seed);    // at edges

// The results of a leak test so far.
struct LeakCounts {
    std::uint64_t rays = 0;
    std::uint64_t leaks = 0;        // rays that lost a crossing
    std::uint64_t double_hits = 0;  // rays with a crossing too many
    std::uint64_t unspecified = 0;  // rounding decides whether a triangle seen edge-on lies before the origin

    std::uint64_t faults() const { return leaks + double_hits; }  // of both kinds
    double bound_95() const;                                      // as in HitClassCounts
};
// A ray with a wrong number of crossings.
struct LeakFault {
    std::uint64_t ray_index = 0;
    Ray ray{};
    uint crossings = 0;    // as counted: an even number
    bool is_leak = false;  // else a double hit
};

// Rays from inside a closed mesh, aimed at its vertices and edges, with all their crossings counted on the device.
class LeakTest {
  public:
    // Fills `accel`, which is empty, has Feature::kernel_queries and outlives the test. Throws Error naming the mesh
    // and an edge that is not between two triangles, if no point inside is found, or if the accelerator was not made
    // for the level.
    LeakTest(AbstractAccel& accel, const Mesh& mesh, Level level, std::uint64_t seed);
    ~LeakTest();

    // Traces the next `count` rays, from counts.rays on, and adds the results. `on_fault` gets each fault.
    void trace(std::size_t count, LeakCounts& counts, const std::function<void(const LeakFault&)>& on_fault = {}) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace twinray
