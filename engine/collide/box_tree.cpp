// SPDX-License-Identifier: MIT
#include "engine/collide/box_tree.h"

#include <bit>

#include "collide_leaves.spv.h"
#include "collide_level.spv.h"
#include "engine/core/error.h"

namespace twinray {

BoxTree::BoxTree(Context& context)
    : context_(context),
      leaves_(context, {.name = "collide_leaves", .spirv = collide_leaves_spirv}),
      level_(context, {.name = "collide_level", .spirv = collide_level_spirv}),
      order_(context) {}

Ref<TreeBox> BoxTree::prepare(std::size_t count) {
    if (count > max_count) fail("box tree: ", count, " boxes; at most ", max_count, " fit");
    count_ = static_cast<uint>(count);
    const std::uint64_t n = count;
    grow(context_, boxes_, "collide boxes", n * sizeof(TreeBox));
    grow(context_, nodes_, "collide nodes", (std::bit_ceil(n) + n) * sizeof(TreeBox));
    order_.prepare(count);
    return boxes_.ref<TreeBox>();
}

BoxTreeView BoxTree::view() const { return {nodes_.ref<TreeBox>(), std::bit_ceil(count_), count_}; }

std::uint64_t BoxTree::bytes() const { return boxes_.bytes() + nodes_.bytes() + order_.bytes(); }

void BoxTree::record(Commands& commands) const {
    if (count_ == 0) return;
    const uint leaf_begin = std::bit_ceil(count_);
    BoxTreeArgs args{.boxes = boxes_.ref<TreeBox>(),
                     .order = order_.record(commands, boxes_.ref<TreeBox>(), count_),
                     .nodes = nodes_.ref<TreeBox>(),
                     .count = count_,
                     .first = leaf_begin,
                     .leaf_begin = leaf_begin,
                     .reserved = 0};
    leaves_.dispatch(commands, args, count_);
    for (args.first = leaf_begin / 2; args.first > 0; args.first /= 2) level_.dispatch(commands, args, args.first);
}

}  // namespace twinray
