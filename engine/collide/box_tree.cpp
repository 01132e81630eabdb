// SPDX-License-Identifier: MIT
#include "engine/collide/box_tree.h"

#include <bit>
#include <cmath>
#include <utility>

#include "collide_centers.spv.h"
#include "collide_codes.spv.h"
#include "collide_leaves.spv.h"
#include "collide_level.spv.h"
#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr uint code_bits = 30;

}  // namespace

HilbertOrder::HilbertOrder(Context& context)
    : context_(context),
      centers_(context, {.name = "collide_centers", .spirv = collide_centers_spirv, .group_size = WORLD_BOUND_GROUP}),
      codes_(context, {.name = "collide_codes", .spirv = collide_codes_spirv}),
      sort_(context),
      bits_(context, {.name = "collide centers", .bytes = sizeof(WorldBoundBits)}) {}

void HilbertOrder::prepare(std::size_t count) {
    grow(context_, scratch_, "collide sort", RadixSort::Scratch{0, count}.bytes(context_.state().tuning()));
}

// Two stable sorts make the order by 60 bits.
Uints HilbertOrder::record(Commands& commands, Ref<TreeBox> boxes, uint count) const {
    {
        const auto pass = commands.pass("collide start");
        commands.write(bits_, WorldBoundBits{uvec3(ordered_bits(INFINITY)), uvec3(ordered_bits(-INFINITY)), 0, 0});
    }
    constexpr uint boxes_of_group = 16 * WORLD_BOUND_GROUP;
    HilbertOrderArgs args{.boxes = boxes,
                          .bits = bits_.ref<WorldBoundBits>(),
                          .keys = {},
                          .order = {},
                          .count = count,
                          .group_count = (count - 1) / boxes_of_group + 1,
                          .is_coarse = 0,
                          .reserved = 0};
    centers_.dispatch_groups(commands, args, args.group_count);
    const RadixSort::Scratch scratch{scratch_.address(), count};
    RadixSort::Pairs pairs = scratch.pairs(), spare = scratch.spare();
    args.keys = pairs.keys;
    codes_.dispatch(commands, args, count);
    const RadixSort::Pairs fine = sort_.record_iota(commands, scratch, code_bits);
    if (fine.values.address != pairs.values.address) std::swap(pairs, spare);
    args.is_coarse = 1;
    args.keys = pairs.keys;
    args.order = pairs.values;
    codes_.dispatch(commands, args, count);
    return sort_.record(commands, pairs, spare, scratch.counters(), count, code_bits).values;
}

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
