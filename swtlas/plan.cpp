#include "swtlas/plan.h"

#include <algorithm>
#include <bit>

#include "engine/accel/geometry.h"
#include "engine/core/error.h"

namespace twinray {
namespace {

// Hands out regions one after the other that begin at cache lines, if the buffer does: a node in two lines would cost
// two misses.
struct Arena {
    std::uint64_t bytes = 0;

    template <class T>
    std::uint64_t take(std::uint64_t count) {
        const std::uint64_t offset = bytes;
        bytes += (count * sizeof(T) + cache_line_bytes - 1) / cache_line_bytes * cache_line_bytes;
        return offset;
    }
};

BuildScratch layout_scratch(const BuildPlan& plan, const KernelTuning& tuning) {
    const uint n = plan.leaf_count;
    Arena arena;
    BuildScratch scratch;
    scratch.trees = arena.take<BuildTree>(plan.first.size());
    scratch.chunks = arena.take<LeafChunk>(plan.chunks.size());
    scratch.boxes = arena.take<LeafBox>(n);
    scratch.centroids = arena.take<CentroidBounds>(plan.first.size());
    scratch.codes = arena.take<uint>(n);
    scratch.low_codes = arena.take<uint>(n);
    scratch.duplicates = arena.take<uint>(plan.first.size());
    scratch.duplicate_codes = arena.take<DuplicateCodes>(1);
    scratch.tree_of = arena.take<uint>(plan.tree_bits ? n : 0);
    scratch.other_bounds = arena.take<uint>(n);
    for (int i = 0; i < 2; ++i) {
        scratch.keys[i] = arena.take<uint>(n);
        scratch.order[i] = arena.take<uint>(n);
    }
    scratch.counters = arena.take<std::byte>(RadixSort::counter_bytes(n, tuning));
    scratch.levels = arena.take<CollapseLevel>(plan.collapse_levels + 2);
    if (!has_records(plan.layout)) {
        scratch.bytes = arena.bytes;
        return scratch;
    }
    Arena refit = arena;
    const std::uint64_t slots = 2 * std::uint64_t{n};
    scratch.slot_boxes = refit.take<LeafBox>(slots);
    scratch.parents = refit.take<uint>(slots);
    scratch.missing = refit.take<uint>(slots);
    scratch.nodes = arena.take<BvhNode>(n);
    scratch.bytes = std::max(arena.bytes, refit.bytes);
    return scratch;
}

// A tree of records is half as deep as a balanced binary one, or less; Morton codes make it deeper. Work that one group
// can do is not worth a dispatch per level.
uint levels_to_collapse(uint leaf_count, uint subtree_leaves) {
    return leaf_count <= subtree_leaves ? 0 : std::min(static_cast<uint>(std::bit_width(leaf_count)), DEEPEST_TREE);
}

}  // namespace

float software_unit(std::span<const vec3> positions) {
    const int exponent = Geometry::size_exponent(positions);
    if (exponent >= -20 && exponent < 60) return 1;
    // A short direction in so large a mesh must not become a denormal, which devices may flush.
    return exponent < 0 ? Geometry::near_unit(positions) : std::ldexp(1.0f, exponent - 30);
}

// A single tree needs no tree_of; all other parts are as long or, rounded up one by one, longer.
std::uint64_t scratch_share(uint leaf_count, Layout layout, const KernelTuning& tuning) {
    Arena tree_of;
    tree_of.take<uint>(leaf_count);
    return plan_build(std::span(&leaf_count, 1), layout, tuning).scratch.bytes + tree_of.bytes;
}

uint inner_count(uint leaf_count) { return std::max(leaf_count, 1u) - 1u; }

BuildPlan plan_build(std::span<const uint> leaf_counts, Layout layout, const KernelTuning& tuning) {
    BuildPlan plan;
    plan.layout = layout;
    std::uint64_t total = 0;
    for (std::size_t tree = 0; tree < leaf_counts.size(); ++tree) {
        plan.first.push_back(static_cast<uint>(total));
        for (uint done = 0; done < leaf_counts[tree]; done += BUILD_GROUP)
            plan.chunks.push_back({static_cast<uint>(tree), static_cast<uint>(total) + done,
                                   std::min(BUILD_GROUP, leaf_counts[tree] - done)});
        total += leaf_counts[tree];
        if (total >= NOTHING) fail("build: ", total, " primitives in one sync; at most ", NOTHING - 1, " fit");
    }
    plan.leaf_count = static_cast<uint>(total);
    plan.has_lone_leaves = std::ranges::all_of(leaf_counts, [](uint count) { return count == 1; });
    if (leaf_counts.size() > 1) plan.tree_bits = static_cast<uint>(std::bit_width(leaf_counts.size() - 1));
    plan.subtree_leaves = tuning.subtree_leaves;
    if (!leaf_counts.empty())
        plan.collapse_levels =
            levels_to_collapse(*std::max_element(leaf_counts.begin(), leaf_counts.end()), plan.subtree_leaves);
    plan.scratch = layout_scratch(plan, tuning);
    return plan;
}

CollapseLists collapse_lists(uint leaf_count) {
    const std::uint64_t large = leaf_count / fewest_large_leaves;
    CollapseLists lists;
    lists.level[1] = large;
    lists.subtrees = 2 * large;
    lists.queues = lists.subtrees + leaf_count / 2;  // that lie apart, of two leaves at least
    lists.end = lists.queues + queue_begin(leaf_count, 0);
    return lists;
}

GeometryLayout layout_geometry(uint leaf_count, std::size_t vertex_count, Layout layout) {
    GeometryLayout parts;
    parts.leaf_count = leaf_count;
    parts.vertex_count = vertex_count;
    if (has_records(layout)) {
        parts.record_count = record_count(leaf_count, width_of(layout));
    } else {
        parts.node_count = inner_count(leaf_count);
        parts.triangle_count = leaf_count;
    }
    Arena arena;
    parts.nodes = arena.take<BvhNode>(parts.node_count);
    parts.triangles = arena.take<BvhTriangle>(parts.triangle_count);
    parts.records = arena.take<CompressedRecord>(parts.record_count);
    parts.vertices = arena.take<vec3>(parts.vertex_count);
    parts.bytes = arena.bytes;
    return parts;
}

SceneLayout layout_scene(uint instance_count, Layout layout) {
    SceneLayout parts;
    parts.node_count = has_records(layout) ? 0 : inner_count(instance_count);
    parts.record_count = has_records(layout) ? record_count(instance_count, width_of(layout)) : 0;
    Arena arena;
    arena.take<SwTlasHeader>(1);
    parts.nodes = arena.take<BvhNode>(parts.node_count);
    parts.instances = arena.take<SwInstance>(instance_count);
    parts.records = arena.take<CompressedRecord>(parts.record_count);
    parts.bytes = arena.bytes;
    return parts;
}

}  // namespace twinray
