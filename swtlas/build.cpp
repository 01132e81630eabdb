// SPDX-License-Identifier: MIT
#include "swtlas/build.h"

#include <algorithm>

#include "swtlas_collapse.spv.h"
#include "swtlas_encode_records.spv.h"
#include "swtlas_encode_triangles.spv.h"
#include "swtlas_hierarchy.spv.h"
#include "swtlas_leaves_instances.spv.h"
#include "swtlas_leaves_triangles.spv.h"
#include "swtlas_morton.spv.h"
#include "swtlas_node_areas.spv.h"
#include "swtlas_parents.spv.h"
#include "swtlas_record_parents.spv.h"
#include "swtlas_refit.spv.h"
#include "swtlas_refit_records.spv.h"
#include "swtlas_refit_triangles.spv.h"
#include "swtlas_tree_keys.spv.h"

namespace twinray {
namespace {

constexpr uint morton_bits = 30;

// `is_needed`: else it is compiled only should it be used after all.
KernelDesc stage(const char* name, std::span<const std::uint32_t> spirv, bool is_needed,
                 uint group_size = BUILD_GROUP) {
    return {.name = name, .spirv = spirv, .group_size = group_size, .compiles_when_used = !is_needed};
}

KernelDesc specialized(KernelDesc desc, uint value) {
    desc.constants = {{0, value}};
    return desc;
}

KernelDesc collapse_stage(uint step, bool is_needed) {
    return specialized(stage("swtlas_collapse", swtlas_collapse_spirv, is_needed, COLLAPSE_GROUP), step);
}

}  // namespace

// Which kernels an accelerator is made for.
struct Builder::Needs {
    explicit Needs(const AccelOptions& options)
        : records(has_records(options.layout)), binary(!records), moves(options.can_move) {}
    bool records, binary, moves;
};

struct Builder::Batch {
    const Buffer& scratch;
    Ref<BuildTree> trees;
    Ref<BuildBlock> blocks;
    Ref<LeafBox> boxes;
    Ref<CentroidBounds> centroids;
    Uints codes, tree_of, meeting, counters;
    RadixSort::Pairs pairs, spare;
    uint block_count;
};

Builder::Builder(Context& context, const AccelOptions& options) : Builder(context, options, Needs(options)) {}

Builder::Builder(Context& context, const AccelOptions& options, const Needs& needs)
    : run_(context.facts().kind == DeviceKind::cpu ? BUILD_GROUP : 8),
      sort_(context),
      areas_(context),
      leaves_triangles_(context, stage("swtlas_leaves_triangles", swtlas_leaves_triangles_spirv, true, LEAVES_GROUP)),
      leaves_instances_(context, stage("swtlas_leaves_instances", swtlas_leaves_instances_spirv, true, LEAVES_GROUP)),
      morton_(context, stage("swtlas_morton", swtlas_morton_spirv, true)),
      node_areas_(context, stage("swtlas_node_areas", swtlas_node_areas_spirv, needs.moves)),
      tree_keys_(context, stage("swtlas_tree_keys", swtlas_tree_keys_spirv, true)),
      hierarchy_(context, specialized(stage("swtlas_hierarchy", swtlas_hierarchy_spirv, true),
                                      options.build_quality == BuildQuality::high ? HIERARCHY_HIGH : HIERARCHY_FAST)),
      encode_triangles_(context, stage("swtlas_encode_triangles", swtlas_encode_triangles_spirv, needs.binary)),
      collapse_roots_(context, collapse_stage(COLLAPSE_ROOTS, needs.records)),
      collapse_level_(context, collapse_stage(COLLAPSE_LEVEL, needs.records)),
      collapse_rest_(context, collapse_stage(COLLAPSE_REST, needs.records)),
      encode_records_(context, stage("swtlas_encode_records", swtlas_encode_records_spirv, needs.records)),
      record_parents_(context,
                      stage("swtlas_record_parents", swtlas_record_parents_spirv, needs.records && needs.moves)),
      refit_records_(context, stage("swtlas_refit_records", swtlas_refit_records_spirv, needs.records && needs.moves)),
      parents_(context, stage("swtlas_parents", swtlas_parents_spirv, needs.binary && needs.moves)),
      refit_(context, stage("swtlas_refit", swtlas_refit_spirv, needs.binary && needs.moves)),
      refit_triangles_(context,
                       stage("swtlas_refit_triangles", swtlas_refit_triangles_spirv, needs.binary && needs.moves)) {}

Builder::Batch Builder::begin(Commands& commands, const BuildPlan& plan, std::span<const BuildTree> trees,
                              const Buffer& scratch) const {
    const BuildScratch& at = plan.scratch;
    const uint none = ordered_bits(-INFINITY), all = ordered_bits(INFINITY);
    const std::vector<CentroidBounds> empty(trees.size(), {uvec3(all), uvec3(none)});
    const std::vector<CollapseLevel> levels(plan.collapse_levels + 2, {0, 1, 1, 0});
    const std::uint64_t base = scratch.address();
    std::vector<BuildTree> with_nodes(trees.begin(), trees.end());
    if (has_records(plan.layout))
        for (BuildTree& tree : with_nodes) tree.nodes.address = base + at.nodes + tree.first * sizeof(BvhNode);
    {
        const auto pass = commands.pass("swtlas build input");
        const Commands::Piece pieces[] = {{at.trees, std::as_bytes(std::span(with_nodes))},
                                          {at.blocks, std::as_bytes(std::span(plan.blocks))},
                                          {at.centroids, std::as_bytes(std::span(empty))},
                                          {at.levels, std::as_bytes(std::span(levels))}};
        commands.upload_pieces(scratch, pieces);
        commands.fill(scratch, at.meeting, std::uint64_t{plan.leaf_count} * sizeof(uint), NOTHING);
    }
    return {scratch,
            {base + at.trees},
            {base + at.blocks},
            {base + at.boxes},
            {base + at.centroids},
            {base + at.codes},
            {plan.tree_bits ? base + at.tree_of : 0},
            {base + at.meeting},
            {base + at.counters},
            {{base + at.keys[0]}, {base + at.order[0]}},
            {{base + at.keys[1]}, {base + at.order[1]}},
            static_cast<uint>(plan.blocks.size())};
}

Uints Builder::record_order(Commands& commands, const BuildPlan& plan, const Batch& batch) const {
    const MortonArgs args{batch.blocks,  batch.boxes,       batch.centroids,
                          batch.codes,   batch.pairs.keys,  batch.pairs.values,
                          batch.tree_of, batch.block_count, 0};
    morton_.dispatch_groups(commands, args, batch.block_count);
    RadixSort::Pairs sorted =
        sort_.record(commands, batch.pairs, batch.spare, batch.counters, plan.leaf_count, morton_bits);
    if (plan.tree_bits == 0) return sorted.values;
    const RadixSort::Pairs other = sorted.keys.address == batch.pairs.keys.address ? batch.spare : batch.pairs;
    tree_keys_.dispatch(commands, {batch.tree_of, sorted.values, sorted.keys, plan.leaf_count, 0}, plan.leaf_count);
    return sort_.record(commands, sorted, other, batch.counters, plan.leaf_count, plan.tree_bits).values;
}

void Builder::record_hierarchy(Commands& commands, const Batch& batch, Uints order, bool leaves_are_sorted) const {
    const HierarchyArgs args{batch.trees,
                             batch.blocks,
                             batch.boxes,
                             batch.codes,
                             order,
                             batch.meeting,
                             batch.centroids,
                             batch.block_count,
                             leaves_are_sorted ? 1u : 0u,
                             run_,
                             0};
    hierarchy_.dispatch(commands, args, std::uint64_t{batch.block_count} * (BUILD_GROUP / run_));
}

void Builder::record_triangles(Commands& commands, const BuildPlan& plan, std::span<const BuildTree> trees,
                               const Buffer& scratch) const {
    if (plan.leaf_count == 0) return;
    const Batch batch = begin(commands, plan, trees, scratch);
    leaves_triangles_.dispatch_groups(
        commands, {batch.trees, batch.blocks, batch.boxes, batch.centroids, batch.block_count, 0}, batch.block_count);
    const Uints order = record_order(commands, plan, batch);
    if (has_records(plan.layout)) {
        record_hierarchy(commands, batch, order, false);
        record_collapse(commands, plan, batch);
        return;
    }
    record_hierarchy(commands, batch, order, true);
    encode_triangles_.dispatch_groups(commands, {batch.trees, batch.blocks, order, batch.block_count, 0},
                                      batch.block_count);
}

void Builder::record_instances(Commands& commands, const BuildPlan& plan, const BuildTree& tree,
                               Ref<InstanceRecord> records, Ref<SwInstance> instances) const {
    if (plan.leaf_count == 0) return;
    Buffer scratch(commands.context(), {.name = "swtlas build scratch", .bytes = plan.scratch.bytes});
    const Batch batch = begin(commands, plan, std::span(&tree, 1), scratch);
    leaves_instances_.dispatch_groups(
        commands, {records, instances, batch.blocks, batch.boxes, batch.centroids, batch.block_count, 0},
        batch.block_count);
    record_hierarchy(commands, batch, record_order(commands, plan, batch), false);
    if (has_records(plan.layout)) record_collapse(commands, plan, batch);
    commands.keep(std::move(scratch));
}

// Levels share the scratch of the sort, which is done: a level has half as many items as there are leaves at most. The
// codes are done, too.
void Builder::record_collapse(Commands& commands, const BuildPlan& plan, const Batch& batch) const {
    record_levels(commands, plan, batch);
    encode_records_.dispatch_groups(commands, {batch.trees, batch.blocks, batch.codes, batch.block_count, 0},
                                    batch.block_count);
}

void Builder::record_levels(Commands& commands, const BuildPlan& plan, const Batch& batch) const {
    const auto pass = commands.pass(collapse_level_.name());
    const auto tree_count = static_cast<uint>(plan.first.size());
    const std::uint64_t items[] = {batch.pairs.keys.address, batch.spare.keys.address};
    const auto level_at = [&](uint level) { return plan.scratch.levels + level * sizeof(CollapseLevel); };
    const auto args = [&](uint level) {
        return CollapseArgs{batch.trees,
                            {items[level % 2]},
                            {items[(level + 1) % 2]},
                            {batch.scratch.address() + level_at(level)},
                            batch.codes,
                            tree_count,
                            0};
    };
    collapse_roots_.dispatch(commands, args(0), tree_count);
    for (uint level = 1; level <= plan.collapse_levels; ++level) {
        commands.barrier();
        collapse_level_.dispatch_indirect(commands, args(level), batch.scratch, level_at(level));
    }
    commands.barrier();
    const uint last = plan.collapse_levels + 1;
    collapse_rest_.dispatch_indirect(commands, args(last), batch.scratch, level_at(last));
}

// The boxes of all inner nodes, and the records, from the boxes of the leaves.
void Builder::record_records_climb(Commands& commands, const BuildPlan& plan, const Batch& batch) const {
    const std::uint64_t base = batch.scratch.address();
    const Uints parents{base + plan.scratch.parents}, missing{base + plan.scratch.missing};
    record_parents_.dispatch_groups(commands, {batch.trees, batch.blocks, parents, missing, batch.block_count, 0},
                                    batch.block_count);
    refit_records_.dispatch_groups(commands,
                                   {batch.trees,
                                    batch.blocks,
                                    batch.boxes,
                                    {base + plan.scratch.slot_boxes},
                                    parents,
                                    missing,
                                    batch.block_count,
                                    0},
                                   batch.block_count);
}

void Builder::record_climb(Commands& commands, const Batch& batch) const {
    // Nothing is sorted in a refit: that scratch holds the parents.
    const Uints node_parents = batch.pairs.keys, leaf_parents = batch.pairs.values;
    parents_.dispatch_groups(commands, {batch.trees, batch.blocks, node_parents, leaf_parents, batch.block_count, 0},
                             batch.block_count);
    refit_.dispatch_groups(
        commands,
        {batch.trees, batch.blocks, batch.boxes, node_parents, leaf_parents, batch.meeting, batch.block_count, 0},
        batch.block_count);
}

namespace {

// The nodes, or the records, among which areas are summed.
uint area_count(const Builder::Measured& tree) {
    return tree.records.address ? record_count(tree.leaf_count) : inner_count(tree.leaf_count);
}

std::uint64_t area_groups(const Builder::Measured& tree) {
    return (std::uint64_t{area_count(tree)} + AREA_GROUP - 1) / AREA_GROUP;
}

}  // namespace

std::uint64_t Builder::cost_bytes(uint leaf_count, Layout layout) {
    // An address stands for any.
    const Measured tree{{}, {has_records(layout) ? 1u : 0u}, {}, leaf_count, {}};
    return AreaWork{area_groups(tree), {}, {}, false}.bytes();
}

void Builder::record_costs(Commands& commands, std::span<const Measured> trees, bool is_build) const {
    std::vector<AreaWork> work;
    for (const Measured& tree : trees) work.push_back({area_groups(tree), {tree.tree.address}, tree.target, is_build});
    SurfaceArea::place(commands, work);
    if (!work.empty()) {
        const auto pass = commands.pass(node_areas_.name());
        for (std::size_t i = 0; i < trees.size(); ++i)
            node_areas_.dispatch_groups(
                commands,
                {trees[i].tree, trees[i].records, trees[i].record_boxes, work[i].items, area_count(trees[i]), 0},
                work[i].item_count);
    }
    areas_.record(commands, std::move(work));
}

void Builder::record_triangle_refit(Commands& commands, const BuildPlan& plan, std::span<const BuildTree> trees,
                                    const Buffer& scratch) const {
    if (plan.leaf_count == 0) return;
    const Batch batch = begin(commands, plan, trees, scratch);
    if (has_records(plan.layout)) return record_records_climb(commands, plan, batch);
    refit_triangles_.dispatch_groups(commands, {batch.trees, batch.blocks, batch.boxes, batch.block_count, 0},
                                     batch.block_count);
    record_climb(commands, batch);
}

void Builder::record_refit(Commands& commands, const BuildPlan& plan, const BuildTree& tree,
                           Ref<InstanceRecord> records, Ref<SwInstance> instances) const {
    if (plan.leaf_count == 0) return;
    Buffer scratch(commands.context(), {.name = "swtlas build scratch", .bytes = plan.scratch.bytes});
    const Batch batch = begin(commands, plan, std::span(&tree, 1), scratch);
    leaves_instances_.dispatch_groups(
        commands, {records, instances, batch.blocks, batch.boxes, batch.centroids, batch.block_count, 0},
        batch.block_count);
    if (has_records(plan.layout))
        record_records_climb(commands, plan, batch);
    else
        record_climb(commands, batch);
    commands.keep(std::move(scratch));
}

}  // namespace twinray
