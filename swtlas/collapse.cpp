// SPDX-License-Identifier: MIT
// Turns binary trees into those of layouts with records.
#include "swtlas/build_batch.h"

namespace twinray {

// The codes and boxes are no longer needed: indices of leaves replace the codes, lists of items the boxes.
void Builder::record_collapse(Commands& commands, const BuildPlan& plan, const Batch& batch,
                              const BuildArgs& args) const {
    const Uints leaf_indices = batch.args.codes;
    {
        const CollapseLists lists = collapse_lists(plan.leaf_count);
        const auto pass = commands.pass(collapse_level_.name());
        const auto list = [&](std::uint64_t first) {
            return Ref<CollapseItem>{args.boxes.address + first * sizeof(CollapseItem)};
        };
        const auto level_at = [&](uint level) { return plan.scratch.levels + level * sizeof(CollapseLevel); };
        const std::uint64_t subtree_level = level_at(plan.collapse_levels + 1);
        const auto args_at = [&](uint level) {
            return CollapseArgs{args.trees,
                                list(lists.level[level % 2]),
                                list(lists.level[(level + 1) % 2]),
                                list(lists.subtrees),
                                list(lists.queues),
                                {batch.scratch.address() + level_at(level)},
                                {batch.scratch.address() + subtree_level},
                                leaf_indices,
                                static_cast<uint>(plan.first.size()),
                                level < plan.collapse_levels ? plan.subtree_leaves : NOTHING};
        };
        collapse_roots_.dispatch(commands, args_at(0), plan.first.size());
        for (uint level = 1; level <= plan.collapse_levels; ++level) {
            commands.barrier();
            collapse_level_.dispatch_indirect(commands, args_at(level), batch.scratch, level_at(level));
        }
        commands.barrier();
        collapse_subtrees_.dispatch_indirect(commands, args_at(0), batch.scratch, subtree_level);
    }
    BuildArgs encode = args;
    encode.codes = leaf_indices;
    encode_records_.dispatch_groups(commands, encode, encode.chunk_count);
}

}  // namespace twinray
