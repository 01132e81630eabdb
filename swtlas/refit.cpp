// SPDX-License-Identifier: MIT
// Refits of built trees, and what their boxes cost.
#include "swtlas/build_batch.h"

namespace twinray {

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
    const Uints leaf_edges = batch.pairs.keys;  // nothing is sorted in a refit
    leaf_edges_.dispatch_groups(commands, {batch.trees, batch.blocks, leaf_edges, batch.block_count, 0},
                                batch.block_count);
    refit_.dispatch_groups(commands,
                           {batch.trees, batch.blocks, batch.boxes, leaf_edges, batch.meeting, batch.block_count, 0},
                           batch.block_count);
}

namespace {

// The nodes, or the records, among which areas are summed.
uint area_count(uint leaf_count, Layout layout) {
    return has_records(layout) ? record_count(leaf_count, width_of(layout)) : inner_count(leaf_count);
}

std::uint64_t area_groups(uint leaf_count, Layout layout) {
    return (std::uint64_t{area_count(leaf_count, layout)} + AREA_GROUP - 1) / AREA_GROUP;
}

}  // namespace

std::uint64_t Builder::cost_bytes(uint leaf_count, Layout layout) {
    return AreaWork{area_groups(leaf_count, layout), {}, {}, false}.bytes();
}

void Builder::record_costs(Commands& commands, std::span<const Measured> trees, bool is_build) const {
    std::vector<AreaWork> work;
    for (const Measured& tree : trees)
        work.push_back({area_groups(tree.leaf_count, layout_), {tree.tree.address}, tree.target, is_build});
    SurfaceArea::place(commands, work);
    if (!work.empty()) {
        const auto pass = commands.pass(node_areas_.name());
        for (std::size_t i = 0; i < trees.size(); ++i)
            node_areas_.dispatch_groups(
                commands, {trees[i].tree, trees[i].records, work[i].items, area_count(trees[i].leaf_count, layout_), 0},
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
    Buffer scratch = build_scratch(commands.context(), plan);
    const Batch batch = begin_instances(commands, plan, tree, records, instances, scratch);
    if (has_records(plan.layout))
        record_records_climb(commands, plan, batch);
    else
        record_climb(commands, batch);
    commands.keep(std::move(scratch));
}

}  // namespace twinray
