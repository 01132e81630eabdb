// SPDX-License-Identifier: MIT
// What to trace, and how.
#pragma once

#include <array>
#include <string_view>

#include "engine/accel/trace_args.h"

namespace twinray {

class TraceProgram;

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
constexpr std::string_view name_of(RayOrder order) { return order == RayOrder::sorted ? "sorted" : "given"; }

// How a ray is tested against triangles, from the fastest to the surest. The hardware accelerator always uses the
// driver's own test: AbstractAccel::capability says what a level is there.
enum class Level : std::uint8_t {
    fast,        // Moeller-Trumbore: may lose rays at edges
    watertight,  // exact edge signs: no leaks, a single hit at an edge
    refined,     // and float64 for t, u, v of the hit that counts
    certified,   // float64 decides what is hit and in which order; software only
};

// How the software accelerator lays out its trees. The hits are the same, bit for bit.
enum class Layout : std::uint8_t {
    compressed4,  // four children a node, boxes in 8 bits a plane, primitives among the nodes: the fastest
    bvh2,         // two children a node, boxes in float32
    compressed8,  // eight children a node of 80 bytes, in an order that a ray's signs give: for GPUs
};

inline constexpr std::array all_layouts = {Layout::compressed4, Layout::bvh2, Layout::compressed8};
constexpr std::string_view name_of(Layout layout) {
    constexpr std::string_view names[] = {"compressed4", "bvh2", "compressed8"};
    return names[static_cast<std::size_t>(layout)];
}
// Whether trees are of records (shaders/shared/compressed.h).
constexpr bool has_records(Layout layout) { return layout != Layout::bvh2; }
// How many children a node has at most.
constexpr uint width_of(Layout layout) { return layout == Layout::bvh2 ? 2 : layout == Layout::compressed8 ? 8 : 4; }

// How the software accelerator builds its trees. The hits are the same, bit for bit.
enum class BuildQuality : std::uint8_t {
    fast,  // along a Morton curve (LBVH)
    high,  // and rotated on the way up: rays meet a seventh fewer boxes where triangles differ much
    ploc,  // from the leaves up, nearest neighbours first (H-PLOC)
};

inline constexpr std::array all_build_qualities = {BuildQuality::fast, BuildQuality::high, BuildQuality::ploc};
constexpr std::string_view name_of(BuildQuality quality) {
    return quality == BuildQuality::fast ? "fast" : quality == BuildQuality::high ? "high" : "ploc";
}

struct AccelOptions {
    // The highest level that traces ask for. From refined on, the accelerator keeps all meshes and transforms on the
    // device; it needs float64 there.
    Level level = Level::watertight;
    Layout layout = Layout::compressed4;              // of software
    BuildQuality build_quality = BuildQuality::fast;  // of software
    // False: instances stay where push() puts them, and whatever would move them throws. Where they stand as their
    // meshes were given, rays of software are then not transformed.
    bool can_move = true;
    // Software: programs for other needs than those of the first trace are compiled by a thread of the accelerator's
    // own, while one that fits all scenes serves. False: traces wait for them.
    bool compiles_in_background = true;
};

// Which triangles are not hit: those seen from the back, or from the front. The front is the side that
// (v1 - v0) x (v2 - v0) points to, in object space: there the corners appear counter-clockwise.
enum class Cull : std::uint8_t { none, back, front };
constexpr uint flags_of(Cull cull) { return cull == Cull::none ? 0 : cull == Cull::back ? CULL_BACK : CULL_FRONT; }

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
    bool answer_only = false;
    RayOrder order = RayOrder::given;
    // Needed where the scene has boxes or filtered instances; made by AbstractAccel::make_program of the same
    // accelerator, and kept alive until the GPU is done.
    const TraceProgram* program = nullptr;
    std::uint64_t user_data = 0;  // for the program: most often the device address of what its primitives are
};

}  // namespace twinray
