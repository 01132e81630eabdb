// SPDX-License-Identifier: MIT
// What to trace and how: queries, levels of certainty, options of accelerators, programs of the application.
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

// The hit with the smallest t, or whichever is found first.
enum class Query : std::uint8_t { closest, any };

// In which order rays are traced. Each hit is written where its ray asks for it, and is the same bits.
enum class RayOrder : std::uint8_t {
    given,
    // By the cell, of a coarse grid in the box of all origins, in which a ray begins, then by the octant of its
    // direction. Pays for many rays in random order on large scenes: docs/bench.md says where. A single ray that begins
    // far away from the others makes the cells coarse. Takes some 16 bytes of device memory a ray for as long as the
    // commands run, and records passes of its own.
    sorted,
};

inline constexpr std::array all_ray_orders = {RayOrder::given, RayOrder::sorted};
// As options spell it.
constexpr std::string_view name_of(RayOrder order) { return order == RayOrder::sorted ? "sorted" : "given"; }

// How a ray is tested against triangles, from the fastest to the surest. The hardware accelerator always uses the
// driver's own test: AbstractAccel::capability says what a level is there.
enum class Level : std::uint8_t {
    fast,        // Moeller-Trumbore: may lose rays at edges
    watertight,  // exact signs of edges and of t: no leaks, a single hit at an edge
    refined,     // and float64 for t, u, v of the hit that counts
    certified,   // float64 decides what is hit and in which order; software only
};
inline constexpr std::array all_levels = {Level::fast, Level::watertight, Level::refined, Level::certified};
// As options spell it.
constexpr std::string_view name_of(Level level) {
    constexpr std::string_view names[] = {"fast", "watertight", "refined", "certified"};
    return names[static_cast<std::size_t>(level)];
}

// How the software accelerator lays out its trees. The hits are the same, bit for bit.
enum class Layout : std::uint8_t {
    compressed4,  // four children a node, boxes in 8 bits a plane, primitives among the nodes: the fastest
    bvh2,         // two children a node, boxes in float32
    compressed8,  // eight children a node of 80 bytes, in an order that a ray's signs give: for GPUs
};

inline constexpr std::array all_layouts = {Layout::compressed4, Layout::bvh2, Layout::compressed8};
// As options spell it.
constexpr std::string_view name_of(Layout layout) {
    constexpr std::string_view names[] = {"compressed4", "bvh2", "compressed8"};
    return names[static_cast<std::size_t>(layout)];
}
// How the software accelerator builds its trees. The hits are the same, bit for bit.
enum class BuildQuality : std::uint8_t {
    fast,  // along a Morton curve (LBVH)
    high,  // and rotated on the way up: rays meet a seventh fewer boxes where triangles differ much
    ploc,  // from the leaves up, nearest neighbours first (H-PLOC)
};

inline constexpr std::array all_build_qualities = {BuildQuality::fast, BuildQuality::high, BuildQuality::ploc};
// As options spell it.
constexpr std::string_view name_of(BuildQuality quality) {
    return quality == BuildQuality::fast ? "fast" : quality == BuildQuality::high ? "high" : "ploc";
}

// How an accelerator is made.
struct AccelOptions {
    // The highest level that traces ask for. From refined on, the accelerator keeps all meshes and transforms on the
    // device; it needs float64 there.
    Level level = Level::watertight;
    Layout layout = Layout::compressed4;              // of software
    BuildQuality build_quality = BuildQuality::fast;  // of software
    // Meshes stay on the device with all that MeshView has of them, for AbstractAccel::surfaces() and
    // twinray/glsl/surface.glsl.
    bool keeps_surfaces = false;
    // Only what handle_of(), index_in_handle(), face_metadata() and geometry_metadata() there read stays: no mesh.
    bool keeps_metadata = false;
    // The host keeps each mesh, 12 bytes a vertex and a triangle. False: from the sync that builds it on nothing can
    // read it back, so that update_vertices() from the host, save(), scene_of() and analyses of it throw.
    bool keeps_meshes = true;
    // False: instances stay where push() puts them, and whatever would move them throws. Where they stand as their
    // meshes were given, rays of software are then not transformed.
    bool can_move = true;
    // Kernels write masks into AbstractAccel::instance_buffer(), too: no trace leaves out that instances have them.
    bool masks_on_device = false;
    // Software: programs for other needs than those of the first trace are compiled by a thread of the accelerator's
    // own, while one that fits all scenes serves. False: traces wait for them.
    bool compiles_in_background = true;
};

// Which triangles are not hit: those seen from the back, or from the front. The front is the side that
// (v1 - v0) x (v2 - v0) points to, in object space: there the corners appear counter-clockwise.
enum class Cull : std::uint8_t { none, back, front };

// What to trace, and where the hits go.
struct TraceDesc {
    Ref<Ray> rays = {};  // device address of count rays, 8-byte aligned
    Ref<Hit> hits = {};  // device address of count hits, 8-byte aligned, apart from the rays; written in no order
    std::uint64_t count = 0;
    // Device address of a uint, 4-byte aligned, or 0: traces min(count, that many) rays; hits beyond stay.
    Uints indirect_count = {};
    Query query = Query::closest;
    std::uint8_t mask = 0xff;
    Cull cull = Cull::none;
    Level level = Level::watertight;
    // Of any hits: of each Hit only `hit` is written for sure; the rest is undefined.
    bool occlusion_only = false;
    RayOrder order = RayOrder::given;
    // Needed where the scene has boxes or non-opaque instances; made by AbstractAccel::make_program of the same
    // accelerator, and kept alive until the GPU is done.
    const TraceProgram* program = nullptr;
    // For the program: most often the device address of what its primitives are. In place of 0 it gets Context::absent.
    std::uint64_t user_data = 0;
};

// What twinray_add_trace_program() of CMake makes of a GLSL file with intersect_primitive and accept_hit (see
// twinray/glsl/program.h): the file compiled into each way of tracing.
struct TraceProgramCode {
    std::string name;
    std::span<const std::uint32_t> software, software_refined;
    std::span<const std::uint32_t> ray_query, ray_query_refined;
    // Of the ray tracing pipeline; empty: none.
    std::span<const std::uint32_t> any_hit;
    std::span<const std::uint32_t> intersection;
};

// Such code, ready to trace with one accelerator. Made by AbstractAccel::make_program.
class TraceProgram {
  public:
    virtual ~TraceProgram() = default;
    TraceProgram(const TraceProgram&) = delete;
    TraceProgram& operator=(const TraceProgram&) = delete;

    std::uint64_t accel() const { return accel_; }     // its AccelView::accel
    uint features() const { return features_; }        // FEATURE_* of the scenes it can trace
    const std::string& name() const { return name_; }  // as in TraceProgramCode

    // Compiles it for a query and a level now; else the first trace of that kind does. Throws Error.
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

// What is told of an instance besides where it is.
struct InstanceOptions {
    uint custom_index = 0;         // returned in Hit::custom_index; at most 2^24 - 1
    std::uint8_t mask = 0xff;      // an instance is seen by rays whose mask shares a bit
    bool disable_culling = false;  // both sides are hit by rays that cull, too
    bool flip_facing = false;      // front and back exchanged
    bool non_opaque = false;       // not opaque: a trace program decides about each hit

    bool operator==(const InstanceOptions&) const = default;
};

// Names what one push placed. Never reused; a handle of another accelerator or of something erased is dead.
struct AccelHandle {
    std::uint64_t id = 0;  // 0 = invalid

    bool operator==(const AccelHandle&) const = default;
};

// A hit in float64.
struct HitExact {
    uint hit = 0;  // 0: a miss, and t is -1
    uint primitive_index = 0, custom_index = 0, instance_index = 0;
    AccelHandle handle;  // of what was pushed: users' ids of surfaces or volumes go by it
    double t = -1, u = 0, v = 0;
};

// An instance as the accelerator holds it.
struct InstanceState {
    Transform transform;
    InstanceOptions options;
};

// What kernels need to trace: valid until the next sync() after which revision() has grown.
struct AccelView {
    std::uint64_t scene = 0;     // device address of the accelerator's header (SwTlasHeader or HwTlasHeader)
    std::uint64_t accel = 0;     // which accelerator made it
    std::uint64_t revision = 0;  // its revision() then
    uint features = 0;           // of whatever traces of it may need: what kernels may be specialised for

    // That of a kernel with twinray/glsl/query.glsl, for its KernelDesc::constants.
    SpecializationConstant features_constant() const;
    bool operator==(const AccelView&) const = default;
};

// What an accelerator may be able to do.
enum class Feature : std::uint8_t {
    closest_hit,
    any_hit,
    deterministic_ties,  // of hits at the same t the lowest (instance, primitive) counts
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

// How far it is.
enum class Support : std::uint8_t {
    unsupported,
    emulated,  // works, but by other means than the accelerator's own
    native,
};

// What an accelerator can do of one feature.
struct Capability {
    Feature feature;
    Support support;
    std::string note;  // how, or why not; may be empty
};

const char* name_of(Feature feature);  // as `twinray devices` writes it
const char* name_of(Support support);  // likewise
Feature feature_of(Level level);       // level_fast, ...

// Device memory that an accelerator holds, in bytes.
struct MemoryUsage {
    std::uint64_t geometries = 0;  // bottom levels, with the tables that lead back to the user's primitives
    std::uint64_t scene = 0;       // the top level
    std::uint64_t instances = 0;   // the records of all instances, and what refining needs of them
    std::uint64_t blocks = 0;      // what the records point at, one a geometry
    std::uint64_t vertices = 0;    // copies of the meshes whose vertices move, or that are refined or have surfaces
    std::uint64_t surfaces = 0;    // what else AccelOptions::keeps_surfaces keeps
    std::uint64_t scratch = 0;     // kept from one sync to the next
    std::uint64_t host = 0;        // of the host's memory: meshes (AccelOptions::keeps_meshes), boxes and records

    std::uint64_t structures() const { return geometries + scene; }  // both levels
    // All that is on the device.
    std::uint64_t total() const { return structures() + instances + blocks + vertices + surfaces + scratch; }
};

// What a build takes, in bytes.
struct BuildBytes {
    std::uint64_t structures = 0;  // stays
    std::uint64_t scratch = 0;     // until the GPU has built
};

// A geometry of which nothing but its size is known.
struct GeometrySize {
    std::uint64_t vertices = 0;
    std::uint64_t triangles = 0;
    bool in_device_memory = false;  // a DeviceMesh
};

// Boxes in object space that stand for primitives of the user's, not owned. A trace program says how rays meet them.
struct BoxesView {
    std::string_view name;
    std::span<const Bounds> boxes;
};

// Of an accelerator.
constexpr std::size_t max_instances = (1u << 24) - 1;  // what Vulkan guarantees at least
constexpr uint max_custom_index = (1u << 24) - 1;

}  // namespace twinray

namespace std {
// Handles hash by their id.
template <>
struct hash<twinray::AccelHandle> {
    size_t operator()(const twinray::AccelHandle& handle) const noexcept { return hash<uint64_t>()(handle.id); }
};
}  // namespace std
