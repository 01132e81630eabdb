// The file of a saved SwTlas: its contents and checks. Pure, tested without a device.
//
//   header | one entry per geometry | per geometry: name, positions, triangles, boxes,
//   nodes and leaves (layout bvh2) or records (the others), instances
//
// Arrays are as in memory, one after the other without padding; trees refer by index: nothing depends on an address.
// Header, entries and the arrays of each geometry have a CRC-32 each, so that every byte of the file is under one.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/accel/geometry.h"
#include "swtlas/structures.h"

namespace twinray {

constexpr uint saved_version = 10;

struct SavedHeader {
    char magic[8];
    uint version;
    uint byte_order;  // 0x01020304 as the writer's memory has it
    // Sizes of the structs in the file, which the version alone does not tell.
    uint header_bytes, entry_bytes, node_bytes, leaf_bytes, record_bytes, instance_bytes;
    uint layout;  // Layout
    uint entries_checksum;
    std::uint64_t file_bytes;
    std::uint64_t geometry_count;
    uint reserved;  // 0
    uint checksum;  // of the header up to here
};

struct SavedEntry {
    std::uint64_t name_bytes, positions, triangles, boxes, nodes, leaves, records, instances;  // how many
    vec3 lo, hi;                                                                               // of Bvh
    uint root;
    uint kind;      // GEOMETRY_*
    float scale;    // of Geometry
    uint checksum;  // of the geometry's arrays
};
static_assert(sizeof(SavedHeader) == 72 && sizeof(SavedEntry) == 104);

// A built geometry and its instances.
struct SavedGeometry {
    Geometry mesh;  // its positions in units of `scale`, its own scale 1
    Bvh bvh;        // nodes: 0
    std::vector<BvhNode> nodes;
    std::vector<BvhTriangle> leaves;
    std::vector<CompressedRecord> records;
    std::vector<InstanceRecord> instances;  // geometry: 0
    float scale = 1;                        // of the geometry: a power of two
};

// The file in pieces; those of the body are the given arrays.
struct EncodedSave {
    std::vector<std::byte> head;
    std::vector<std::span<const std::byte>> body;
};
EncodedSave encode_save(Layout layout, std::span<const SavedGeometry> geometries);

// Throws Error, naming `object`, on anything that encode_save would not have made, and on trees that traversal could
// not walk safely: a checksum finds accidents, not malice. Allocates at most one and a half times the file's length.
struct DecodedSave {
    Layout layout;
    std::vector<SavedGeometry> geometries;
};
DecodedSave decode_save(std::span<const std::uint8_t> file, const std::string& object);

}  // namespace twinray
