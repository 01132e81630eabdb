// SPDX-License-Identifier: MIT
// Meshes that kernels or other programs have written to device memory: for AbstractAccel::push and update.
//
//     DeviceMesh mesh{.name = "water", .positions = vertices.address(), .vertex_count = n,
//                     .indices = indices.address(), .triangle_count = most, .count_on_device = counter.ref<uint>()};
//     AccelHandle water = accel.push(mesh);  // read by the next sync, on the device
#pragma once

#include <optional>

#include <twinray/geometry.h>

namespace twinray {

// The type of a position's numbers, three from the start of each vertex. 16 bits are IEEE half, or -32767 to 32767 for
// -1 to 1; arrays of 16 bits are read by words of 4 bytes, so up to 2 bytes before or behind them.
enum class VertexFormat : std::uint8_t { float32, float16, snorm16 };
// Returns the bytes of one number.
constexpr std::uint32_t component_bytes(VertexFormat format) { return format == VertexFormat::float32 ? 4 : 2; }

// The type of a triangle's three indices.
enum class IndexFormat : std::uint8_t {
    none,  // triangle i has the vertices 3i, 3i + 1, 3i + 2
    uint16,
    uint32,
};

// A further array of such a mesh (see AttributeView): float32, tightly packed.
struct DeviceAttribute {
    std::string_view name;  // "normals", "tangents", "uv0", "uv1" and "colors" are MeshView's, with their components
    uint components = 1;    // 1 to 4
    bool is_per_face = false;
    Floats values;
};

// A mesh whose large parts are all in device memory. The host reads none of it: kernels must have written it in work
// that was submitted before the sync, or recorded before it into the same commands.
struct DeviceMesh {
    std::string_view name;
    std::uint64_t positions = 0;  // device address of the first vertex, a multiple of a component's size
    std::uint32_t stride = 12;    // bytes from one vertex to the next, a multiple of a component's size
    VertexFormat format = VertexFormat::float32;
    std::size_t vertex_count = 0;
    std::uint64_t indices = 0;  // device address of 3 indices per triangle, a multiple of their size; 0 with none
    IndexFormat index_format = IndexFormat::uint32;
    std::size_t triangle_count = 0;
    // Device address of a uint, or 0. The mesh has min(triangle_count, that number) triangles; the tree has room for
    // all triangle_count and takes their time. Those beyond the number are inactive.
    Uints count_on_device = {};
    // A box around the positions, so that meshes far from 1 in size are built in units near it: in SwTlas if its
    // largest coordinate is below 2^-20 or above 2^60, in HwTlas in the power of two below it. Without it, units are 1.
    std::optional<Bounds> bounds = {};
    // False: each sync that sees a change copies the mesh, and the caller's memory is free once that sync is done.
    // True: no copy is kept; the arrays must stay, and only kernels may write them that run before a sync announced by
    // mark_vertices_dirty(). With AccelOptions::keeps_surfaces or Level::refined it then needs float32, stride 12 and
    // 32-bit indices, in units of 1.
    bool in_place = false;

    // Data for surfaces, with AccelOptions::keeps_surfaces; copied and kept as the mesh is.
    std::span<const DeviceAttribute> attributes = {};
    Uints face_metadata = {};
    std::span<const std::byte> metadata = {};
};

}  // namespace twinray
