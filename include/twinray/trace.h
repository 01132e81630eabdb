// SPDX-License-Identifier: MIT
// Parameters of traces: queries, levels of certainty, options of accelerators, trace programs of the application.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <twinray/geometry.h>

namespace twinray {

#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/ray64.h"
#include "twinray/glsl/surface.h"
#include "twinray/glsl/cpp_end.h"

struct SpecializationConstant;
struct TraceArgs;
class Commands;
class TraceProgram;

// The hit that is wanted: the one with the smallest t, or any one.
enum class Query : std::uint8_t { closest, any };

// The order in which rays are traced. Each hit is written at its ray's index and has the same bits in either order.
enum class RayOrder : std::uint8_t {
    given,
    // Sorted by the cell of a coarse grid, over the box of all origins, in which a ray begins, then by the octant of
    // its direction. It pays for many rays in random order on large scenes: see docs/bench.md. A single ray that begins
    // far away from the others makes the cells coarse. It takes some 16 bytes of device memory per ray while the
    // commands run, and records passes of its own.
    sorted,
};

inline constexpr std::array all_ray_orders = {RayOrder::given, RayOrder::sorted};
// Returns the spelling that options use.
constexpr std::string_view name_of(RayOrder order) { return order == RayOrder::sorted ? "sorted" : "given"; }

// How a ray is tested against triangles, from the fastest to the surest. The hardware accelerator always uses the
// driver's own test: AbstractAccel::capability() says what it does for each level.
enum class Level : std::uint8_t {
    fast,        // Moeller-Trumbore: may lose rays at edges
    watertight,  // exact signs of edges and of t: no leaks, a single hit at an edge
    refined,     // like watertight, with t, u, v of the final hit in float64
    certified,   // float64 decides which hits there are and their order; software only
};
inline constexpr std::array all_levels = {Level::fast, Level::watertight, Level::refined, Level::certified};
// Returns the spelling that options use.
constexpr std::string_view name_of(Level level) {
    constexpr std::string_view names[] = {"fast", "watertight", "refined", "certified"};
    return names[static_cast<std::size_t>(level)];
}

// How the software accelerator lays out its trees. The hits are the same, bit for bit.
enum class Layout : std::uint8_t {
    compressed4,  // four children per node, boxes in 8 bits per plane, primitives among the nodes: the fastest
    bvh2,         // two children per node, boxes in float32
    compressed8,  // eight children per node of 80 bytes, in an order that a ray's signs give: for GPUs
};

inline constexpr std::array all_layouts = {Layout::compressed4, Layout::bvh2, Layout::compressed8};
// Returns the spelling that options use.
constexpr std::string_view name_of(Layout layout) {
    constexpr std::string_view names[] = {"compressed4", "bvh2", "compressed8"};
    return names[static_cast<std::size_t>(layout)];
}
// How the software accelerator builds its trees. The hits are the same, bit for bit.
enum class BuildQuality : std::uint8_t {
    fast,  // along a Morton curve (LBVH)
    high,  // likewise, and rotated on the way up: rays meet a seventh fewer boxes if triangle sizes differ much
    ploc,  // from the leaves up, nearest neighbours first (H-PLOC)
};

inline constexpr std::array all_build_qualities = {BuildQuality::fast, BuildQuality::high, BuildQuality::ploc};
// Returns the spelling that options use.
constexpr std::string_view name_of(BuildQuality quality) {
    return quality == BuildQuality::fast ? "fast" : quality == BuildQuality::high ? "high" : "ploc";
}

// Options that an accelerator is made with.
struct AccelOptions {
    // The highest level that traces may use. From refined on, the accelerator keeps all meshes and transforms on the
    // device, which must support float64.
    Level level = Level::watertight;
    Layout layout = Layout::compressed4;              // software only
    BuildQuality build_quality = BuildQuality::fast;  // software only
    // Keeps meshes on the device with all data that MeshView has, for AbstractAccel::surfaces() and
    // twinray/glsl/surface.glsl.
    bool keeps_surfaces = false;
    // Keeps only what handle_of(), index_in_handle(), face_metadata() and geometry_metadata() there read: no mesh.
    bool keeps_metadata = false;
    // Keeps each mesh on the host, 12 bytes per vertex and per triangle. False: once a sync has built the mesh, nothing
    // can read it back, so that update_vertices() from the host, save(), mesh(), scene_of() and analyses of it throw.
    bool keeps_meshes = true;
    // False: instances stay where push() puts them, and every call that would move them throws. Software then does not
    // transform rays for instances with the identity transform.
    bool can_move = true;
    // Kernels may also write masks into AbstractAccel::instance_buffer(): traces then always test the instances' masks.
    bool masks_on_device = false;
    // Software only: if a trace needs a program for other features than the first trace, a thread of the accelerator
    // compiles it while a program that fits all scenes serves. False: traces wait for the compiler.
    bool compiles_in_background = true;
};

// The triangles that are ignored: those seen from the back, or from the front. The front is the side that (v1 - v0) x
// (v2 - v0) points to, in object space: seen from there, the corners are counter-clockwise.
enum class Cull : std::uint8_t { none, back, front };

// Describes a trace: its rays, its options and where the hits go.
struct TraceDesc {
    Ref<Ray> rays = {};  // device address of count rays, 8-byte aligned
    Ref<Hit> hits = {};  // device address of count hits, 8-byte aligned, apart from the rays; written in no order
    std::uint64_t count = 0;
    // Device address of a uint, 4-byte aligned, or 0: traces min(count, that number) rays; later hits are unchanged.
    Uints indirect_count = {};
    Query query = Query::closest;
    std::uint8_t mask = 0xff;
    Cull cull = Cull::none;
    Level level = Level::watertight;
    // For Query::any: only the field `hit` of each Hit is sure to be written; the rest is undefined.
    bool occlusion_only = false;
    RayOrder order = RayOrder::given;
    // Needed if the scene has boxes or non-opaque instances. It comes from AbstractAccel::make_program() of the same
    // accelerator and must live until the GPU is done.
    const TraceProgram* program = nullptr;
    // Passed to the program: usually the device address of its data. 0 is replaced by Context::absent().
    std::uint64_t user_data = 0;
};

// The modules that twinray_add_trace_program() of CMake makes from a GLSL file with intersect_primitive and accept_hit
// (see twinray/glsl/program.h): the file compiled for each way of tracing.
struct TraceProgramCode {
    std::string name;
    std::span<const std::uint32_t> software, software_refined;
    std::span<const std::uint32_t> ray_query, ray_query_refined;
    // For the ray tracing pipeline; empty if there is none.
    std::span<const std::uint32_t> any_hit;
    std::span<const std::uint32_t> intersection;
};

// A TraceProgramCode that is ready to trace with one accelerator; AbstractAccel::make_program() makes it.
class TraceProgram {
  public:
    virtual ~TraceProgram() = default;
    TraceProgram(const TraceProgram&) = delete;
    TraceProgram& operator=(const TraceProgram&) = delete;

    std::uint64_t accel() const { return accel_; }     // its AccelView::accel
    uint features() const { return features_; }        // FEATURE_* of the scenes it can trace
    const std::string& name() const { return name_; }  // as in TraceProgramCode

    // Compiles it for a query and a level now; otherwise the first such trace does. Throws Error.
    virtual void prepare(Query query, Level level) const = 0;
    // Records args.count rays.
    virtual void record(Commands& commands, const TraceArgs& args, Query query, Level level) const = 0;

  protected:
    TraceProgram(std::uint64_t accel, uint features, std::string name)
        : accel_(accel), features_(features), name_(std::move(name)) {}

  private:
    std::uint64_t accel_;
    uint features_;
    std::string name_;
};

// Options of an instance apart from its transform.
struct InstanceOptions {
    uint custom_index = 0;         // returned in Hit::custom_index; at most 2^24 - 1
    std::uint8_t mask = 0xff;      // an instance is seen by rays whose mask shares a bit
    bool disable_culling = false;  // rays that cull hit both sides
    bool flip_facing = false;      // front and back exchanged
    bool non_opaque = false;       // not opaque: a trace program decides about each hit

    bool operator==(const InstanceOptions&) const = default;
};

// Names the result of one push. Never reused; a handle of another accelerator or of something erased is dead.
struct AccelHandle {
    std::uint64_t id = 0;  // 0 = invalid

    bool operator==(const AccelHandle&) const = default;
};

// A hit in float64.
struct HitExact {
    uint hit = 0;  // 0: a miss, and t is -1
    uint primitive_index = 0, custom_index = 0, instance_index = 0;
    AccelHandle handle;  // of the pushed object: applications keep ids of surfaces or volumes by it
    double t = -1, u = 0, v = 0;
};

// An instance as the accelerator holds it.
struct InstanceState {
    Transform transform;
    InstanceOptions options;
};

// The data that kernels need to trace: valid until the next sync() after which revision() has grown.
struct AccelView {
    std::uint64_t scene = 0;     // device address of the accelerator's header (SwTlasHeader or HwTlasHeader)
    std::uint64_t accel = 0;     // identifies the accelerator that made it
    std::uint64_t revision = 0;  // the accelerator's revision() at that time
    uint features = 0;           // FEATURE_* that any trace of it may need: kernels may be specialised for them

    // Returns the constant for KernelDesc::constants of a kernel with twinray/glsl/query.glsl.
    SpecializationConstant features_constant() const;
    bool operator==(const AccelView&) const = default;
};

// A capability that accelerators may have.
enum class Feature : std::uint8_t {
    closest_hit,
    any_hit,
    deterministic_ties,  // among hits at the same t, the lowest (instance, primitive) counts
    masks,
    culling,
    boxes,           // geometry of boxes with the user's intersection
    filters,         // any-hit filters
    kernel_queries,  // twinray/glsl/query.glsl inside kernels
    level_fast,
    level_watertight,
    level_refined,
    level_certified,
    refit_instances,
    refit_vertices,
    compaction,
    save_and_load,
};
constexpr std::size_t feature_count = 16;

// How well a feature is supported.
enum class Support : std::uint8_t {
    unsupported,
    emulated,  // works, but by other means than the accelerator's own
    native,
};

// The support that an accelerator has for one feature.
struct Capability {
    Feature feature;
    Support support;
    std::string note;  // how, or why not; may be empty
};

const char* name_of(Feature feature);  // the spelling of `twinray devices`
const char* name_of(Support support);  // likewise
Feature feature_of(Level level);       // level_fast, ...

// Device memory that an accelerator holds, in bytes.
struct MemoryUsage {
    std::uint64_t geometries = 0;  // bottom levels, with the tables that lead back to the user's primitives
    std::uint64_t scene = 0;       // the top level
    std::uint64_t instances = 0;   // the records of all instances, and their data for refining
    std::uint64_t blocks = 0;      // the data that the records point at, one block per geometry
    std::uint64_t vertices = 0;    // copies of meshes whose vertices move, or that are refined or have surfaces
    std::uint64_t surfaces = 0;    // the other data that AccelOptions::keeps_surfaces keeps
    std::uint64_t scratch = 0;     // kept from one sync to the next
    std::uint64_t host = 0;        // in host memory: meshes, also those that are shared, boxes and records

    std::uint64_t structures() const { return geometries + scene; }  // both levels
    // All that is on the device.
    std::uint64_t total() const { return structures() + instances + blocks + vertices + surfaces + scratch; }
};

// Device memory that a build takes, in bytes.
struct BuildBytes {
    std::uint64_t structures = 0;  // kept
    std::uint64_t scratch = 0;     // until the GPU has built
};

// The size of a geometry whose contents are not known yet.
struct GeometrySize {
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
    bool in_device_memory = false;  // a DeviceMesh
};

// Boxes in object space around primitives of the application, not owned. A trace program intersects these with rays.
struct BoxesView {
    std::string_view name;
    std::span<const Bounds> boxes;
};

// Limits of an accelerator.
constexpr std::size_t max_instances = (1u << 24) - 1;  // the number that Vulkan guarantees at least
constexpr uint max_custom_index = (1u << 24) - 1;

}  // namespace twinray

namespace std {
// Hashes a handle by its id.
template <>
struct hash<twinray::AccelHandle> {
    size_t operator()(const twinray::AccelHandle& handle) const noexcept { return hash<uint64_t>()(handle.id); }
};
}  // namespace std
