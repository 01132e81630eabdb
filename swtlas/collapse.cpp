// SPDX-License-Identifier: MIT
// From binary trees to those of layouts with records.
#include "swtlas/build_batch.h"

namespace twinray {

// Places lie where the codes were, which are done.
void Builder::record_collapse(Commands& commands, const BuildPlan& plan, const Batch& batch,
                              const RadixSort::Pairs& sorted) const {
    record_levels(commands, plan, batch);
    encode_records_.dispatch_groups(
        commands, {batch.trees, batch.blocks, sorted.values, batch.codes, batch.block_count, 0}, batch.block_count);
}

// Lists of items lie where the boxes were, which are done, too.
void Builder::record_levels(Commands& commands, const BuildPlan& plan, const Batch& batch) const {
    const CollapseLists lists = collapse_lists(plan.leaf_count);
    const auto pass = commands.pass(collapse_level_.name());
    const auto list = [&](std::uint64_t first) {
        return Ref<CollapseItem>{batch.boxes.address + first * sizeof(CollapseItem)};
    };
    const auto level_at = [&](uint level) { return plan.scratch.levels + level * sizeof(CollapseLevel); };
    const std::uint64_t subtree_level = level_at(plan.collapse_levels + 1);
    const auto args = [&](uint level) {
        return CollapseArgs{batch.trees,
                            list(lists.level[level % 2]),
                            list(lists.level[(level + 1) % 2]),
                            list(lists.subtrees),
                            list(lists.queues),
                            {batch.scratch.address() + level_at(level)},
                            {batch.scratch.address() + subtree_level},
                            batch.codes,
                            static_cast<uint>(plan.first.size()),
                            level < plan.collapse_levels ? plan.subtree_leaves : NOTHING};
    };
    collapse_roots_.dispatch(commands, args(0), plan.first.size());
    for (uint level = 1; level <= plan.collapse_levels; ++level) {
        commands.barrier();
        collapse_level_.dispatch_indirect(commands, args(level), batch.scratch, level_at(level));
    }
    commands.barrier();
    collapse_subtrees_.dispatch_indirect(commands, args(0), batch.scratch, subtree_level);
}

}  // namespace twinray
