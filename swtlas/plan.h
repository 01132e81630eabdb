// All decisions that a batch of builds makes before it records: pure, tested without a device.
#pragma once

#include <span>
#include <vector>

#include "swtlas/structures.h"

namespace twinray {

// Returns the unit in which the software traversal wants a mesh: 1 if its largest coordinate is between 2^-20 and 2^60,
// where products of two coordinates and their rounding errors stay in the range of float32, so that parts that are far
// smaller than the mesh keep their size; else a power of two near its size, of a large one 2^-30 of it.
float software_unit(std::span<const vec3> positions);

// Byte offsets into one scratch buffer.
struct BuildScratch {
    std::uint64_t trees = 0, chunks = 0, boxes = 0, centroids = 0, codes = 0, low_codes = 0, duplicates = 0,
                  duplicate_codes = 0;
    std::uint64_t tree_of = 0, other_bounds = 0;
    std::uint64_t keys[2] = {}, order[2] = {};
    std::uint64_t counters = 0, levels = 0;
    std::uint64_t nodes = 0;                                 // of layouts with records, whose trees do not keep them
    std::uint64_t slot_boxes = 0, parents = 0, missing = 0;  // of a refit in those: in the place of the nodes
    std::uint64_t bytes = 0;
};

struct BuildPlan {
    std::vector<uint> first;        // by tree: its first leaf in the batch
    std::vector<LeafChunk> chunks;  // of leaves of one tree, a group each
    uint leaf_count = 0;            // of the batch
    bool has_lone_leaves = false;   // each tree has one
    uint tree_bits = 0;             // bits of the largest tree index; 0 = one tree, no sort by tree
    uint collapse_levels = 0;       // below the roots that are collapsed one by one; the rest goes by subtrees
    uint subtree_leaves = 0;        // of a subtree that a group collapses whole, at most, while there are levels left
    Layout layout = Layout::compressed4;
    BuildScratch scratch;
};

// Throws Error if the batch has 2^32 leaves or more.
BuildPlan plan_build(std::span<const uint> leaf_counts, Layout layout, const KernelTuning& tuning);

// Returns the most that a tree of so many leaves adds to the scratch of its batch.
std::uint64_t scratch_share(uint leaf_count, Layout layout, const KernelTuning& tuning);

// The fewest leaves of an item that may be in a list of a level: 1 / so many of all leaves have room there.
constexpr uint fewest_large_leaves = 12;

// The starts of the lists of items of collapsing, and the end of the last one, in items; n boxes have room for 3 n / 2.
struct CollapseLists {
    std::uint64_t level[2] = {}, subtrees = 0, queues = 0, end = 0;
};
CollapseLists collapse_lists(uint leaf_count);

uint inner_count(uint leaf_count);

// The offsets of the parts of a built geometry in its buffer, and their counts; its SwGeometry is the geometry block.
struct GeometryLayout {
    uint leaf_count = 0, node_count = 0, triangle_count = 0, record_count = 0;
    std::size_t vertex_count = 0;
    std::uint64_t nodes = 0, triangles = 0, records = 0, vertices = 0, bytes = 0;
};
// `vertex_count`: vertices that only leaves of two triangles need on the device; 0 for other leaves.
GeometryLayout layout_geometry(uint leaf_count, std::size_t vertex_count, Layout layout);

// The offsets of the parts of a scene in its buffer; its SwTlasHeader is at 0.
struct SceneLayout {
    uint node_count = 0, record_count = 0;
    std::uint64_t nodes = 0, instances = 0, records = 0, bytes = 0;
};
SceneLayout layout_scene(uint instance_count, Layout layout);

}  // namespace twinray
