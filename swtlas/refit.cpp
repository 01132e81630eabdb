// SPDX-License-Identifier: MIT
// Refits built trees, and measures their cost.
#include "swtlas/build_batch.h"

namespace twinray {

// Computes the boxes of all inner nodes, and the records, from the boxes of the leaves. A refit sorts nothing: in
// layout bvh2, edges take the place of keys.
void Builder::record_boxes(Commands& commands, const BuildPlan& plan, const Batch& batch) const {
    if (plan.has_lone_leaves) return lone_leaves_.dispatch(commands, batch.args, plan.leaf_count);
    const std::uint64_t base = batch.scratch.address();
    const uint chunks = batch.args.chunk_count;
    RefitArgs args{batch.args.trees, batch.args.chunks, batch.args.boxes, {}, {}, {}, chunks, 0};
    if (has_records(plan.layout)) {
        args.slot_boxes.address = base + plan.scratch.slot_boxes;
        args.parents.address = base + plan.scratch.parents;
        args.missing.address = base + plan.scratch.missing;
        record_parents_.dispatch_groups(commands, args, chunks);
        refit_records_.dispatch_groups(commands, args, chunks);
        return;
    }
    args.parents = batch.pairs.keys;
    args.missing = batch.args.other_bounds;
    if (batch.args.leaves_are_sorted) refit_triangles_.dispatch_groups(commands, args, chunks);
    leaf_edges_.dispatch_groups(commands, args, chunks);
    refit_.dispatch_groups(commands, args, chunks);
}

namespace {

// Returns the number of nodes, or of records, whose areas are summed.
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
    if (plan.leaf_count != 0) record_boxes(commands, plan, begin(commands, plan, trees, scratch));
}

void Builder::record_refit(Commands& commands, const BuildPlan& plan, const InstanceTree& tree) const {
    if (plan.leaf_count == 0) return;
    if (plan.has_lone_leaves) return record_lone_instance(commands, tree);
    Buffer scratch = build_scratch(commands.context(), plan);
    record_boxes(commands, plan, begin_instances(commands, plan, tree, scratch));
    commands.retain(std::move(scratch));
}

}  // namespace twinray
