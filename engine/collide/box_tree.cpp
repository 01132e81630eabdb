// SPDX-License-Identifier: MIT
#include "engine/collide/box_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "collide_centers.spv.h"
#include "collide_codes.spv.h"
#include "collide_leaves.spv.h"
#include "collide_level.spv.h"
#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr uint code_bits = 30;

Uints column(const Buffer& scratch, std::uint64_t count, std::uint64_t index) {
    return scratch.ref<uint>(index * count * sizeof(uint));
}

void grow(Context& context, Buffer& buffer, const char* name, std::uint64_t bytes) {
    if (buffer.bytes() < bytes) buffer = Buffer(context, {.name = name, .bytes = bytes});
}

}  // namespace

BoxTree::BoxTree(Context& context)
    : context_(context),
      centers_(context, {.name = "collide_centers", .spirv = collide_centers_spirv, .group_size = WORLD_BOUND_GROUP}),
      codes_(context, {.name = "collide_codes", .spirv = collide_codes_spirv}),
      leaves_(context, {.name = "collide_leaves", .spirv = collide_leaves_spirv}),
      level_(context, {.name = "collide_level", .spirv = collide_level_spirv}),
      sort_(context),
      bits_(context, {.name = "collide centers", .bytes = sizeof(WorldBoundBits)}) {}

Ref<TreeBox> BoxTree::prepare(std::size_t count) {
    if (count > max_count) fail("box tree: ", count, " boxes; at most ", max_count, " fit");
    count_ = static_cast<uint>(count);
    const std::uint64_t n = count;
    grow(context_, boxes_, "collide boxes", n * sizeof(TreeBox));
    grow(context_, nodes_, "collide nodes", (std::bit_ceil(n) + n) * sizeof(TreeBox));
    grow(context_, scratch_, "collide sort", 4 * n * sizeof(uint) + RadixSort::counter_bytes(n));
    return boxes_.ref<TreeBox>();
}

BoxTreeView BoxTree::view() const { return {nodes_.ref<TreeBox>(), std::bit_ceil(count_), count_}; }

std::uint64_t BoxTree::bytes() const { return boxes_.bytes() + nodes_.bytes() + scratch_.bytes(); }

void BoxTree::record(Commands& commands) const {
    if (count_ == 0) return;
    {
        const auto pass = commands.pass("collide start");
        commands.write(bits_, WorldBoundBits{uvec3(ordered_bits(INFINITY)), uvec3(ordered_bits(-INFINITY)), 0, 0});
    }
    constexpr uint boxes_of_group = 16 * WORLD_BOUND_GROUP;
    const uint leaf_begin = std::bit_ceil(count_);
    BoxTreeArgs args{.boxes = boxes_.ref<TreeBox>(),
                     .bits = bits_.ref<WorldBoundBits>(),
                     .keys = {},
                     .order = {},
                     .nodes = nodes_.ref<TreeBox>(),
                     .count = count_,
                     .group_count = (count_ - 1) / boxes_of_group + 1,
                     .first = leaf_begin,
                     .leaf_begin = leaf_begin,
                     .is_coarse = 0,
                     .reserved = 0};
    centers_.dispatch_groups(commands, args, args.group_count);
    args.order = record_order(commands, args);
    leaves_.dispatch(commands, args, count_);
    for (args.first = leaf_begin / 2; args.first > 0; args.first /= 2) level_.dispatch(commands, args, args.first);
}

// By 60 bits in two stable sorts, so that boxes crowded in one cell of the coarser grid are told apart.
Uints BoxTree::record_order(Commands& commands, BoxTreeArgs args) const {
    RadixSort::Pairs pairs{column(scratch_, count_, 0), column(scratch_, count_, 1)};
    RadixSort::Pairs spare{column(scratch_, count_, 2), column(scratch_, count_, 3)};
    for (args.is_coarse = 0; args.is_coarse < 2; ++args.is_coarse) {
        args.keys = pairs.keys;
        args.order = pairs.values;
        codes_.dispatch(commands, args, count_);
        const RadixSort::Pairs sorted =
            sort_.record(commands, pairs, spare, column(scratch_, count_, 4), count_, code_bits);
        if (sorted.values.address != pairs.values.address) std::swap(pairs, spare);
    }
    return pairs.values;
}

}  // namespace twinray
