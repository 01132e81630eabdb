#include "engine/collide/box_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "collide_centers.spv.h"
#include "collide_codes.spv.h"
#include "collide_leaves.spv.h"
#include "collide_level.spv.h"
#include "collide_pairs.spv.h"
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

std::vector<uint> download(Context& context, const DevicePairs& pairs, std::uint64_t DevicePairs::*column) {
    if (pairs.count == 0) return {};
    return download<uint>(context, *pairs.buffer, pairs.count, pairs.*column - pairs.buffer->address());
}

PairSearch::PairSearch(Context& context)
    : context_(context),
      kernel_(context, {.name = "collide_pairs", .spirv = collide_pairs_spirv}),
      sort_(context),
      total_(context, {.name = "collide total", .bytes = sizeof(ListTotal)}),
      readback_(context, {.name = "collide total readback", .bytes = sizeof(ListTotal), .memory = Memory::readback}),
      pace_(context) {}

void PairSearch::set_max_pairs(std::uint64_t count) {
    if (count > most_pairs) fail("set_max_pairs: ", count, " pairs; at most ", most_pairs, " can be numbered");
    max_pairs_ = count;
}

RadixSort::Pairs PairSearch::columns(const Buffer& buffer, std::uint64_t count) {
    return {buffer.ref<uint>(), buffer.ref<uint>(count * sizeof(uint))};
}

void PairSearch::reserve(std::uint64_t count) { grow(context_, pairs_, "collide pairs", count * 2 * sizeof(uint)); }

std::uint64_t PairSearch::run(const Query& query, std::uint64_t capacity, uint flags) {
    const bool is_within = query.boxes.address == 0;
    const uint queries = is_within ? query.tree.count : query.box_count;
    if (queries == 0 || query.tree.count == 0) return 0;
    const RadixSort::Pairs out = columns(pairs_, capacity);
    PairSearchArgs args{
        .nodes = query.tree.nodes,
        .queries = is_within ? query.tree.leaves() : query.boxes,
        .first = out.keys,
        .second = out.values,
        .total = total_.ref<ListTotal>(),
        .query_begin = 0,
        .query_end = 0,
        .leaf_begin = query.tree.leaf_begin,
        .leaf_count = query.tree.count,
        .capacity = static_cast<uint>(capacity),
        .flags = flags | (is_within ? SEARCH_WITHIN : 0) | (query.other_groups ? SEARCH_OTHER_GROUPS : 0)};
    Commands commands(context_, "collide search");
    {
        const auto pass = commands.pass("collide search start");
        commands.write(total_, ListTotal{0, 0});
    }
    pace_.record(commands, queries, [&](std::uint64_t first, std::uint64_t count) {
        args.query_begin = static_cast<uint>(first);
        args.query_end = static_cast<uint>(first + count);
        kernel_.dispatch(commands, args, count);
    });
    {
        const auto pass = commands.pass("collide search readback");
        commands.copy(total_, 0, readback_, 0, sizeof(ListTotal));
    }
    pace_.finish(commands);
    ListTotal total;
    std::memcpy(&total, readback_.mapped(), sizeof total);
    return std::uint64_t{total.high} << 32 | total.low;
}

DevicePairs PairSearch::find(const Query& query, const std::string& action) {
    const std::uint64_t guess = std::max<std::uint64_t>(1024, 4 * std::uint64_t{query.tree.count});
    reserve(std::min(max_pairs_, guess));
    std::uint64_t room = std::min(capacity(), max_pairs_);
    const std::uint64_t total = run(query, room, 0);
    if (total > max_pairs_)
        fail(action, ": ", total, " pairs of boxes overlap; at most ", max_pairs_,
             " are allowed, see set_max_pairs(): a pair takes up to 17 bytes of device memory");
    if (total > room) {
        reserve(total);
        room = total;
        run(query, room, 0);
    }
    const RadixSort::Pairs found = columns(pairs_, room);
    return {found.keys.address, found.values.address, total, &pairs_};
}

DevicePairs PairSearch::find_sorted(const Query& query, uint largest_item, const std::string& action) {
    const DevicePairs found = find(query, action);
    if (found.count < 2) return found;
    grow(context_, spare_, "collide pairs sorting", found.count * 2 * sizeof(uint));
    grow(context_, counters_, "collide counters", RadixSort::counter_bytes(found.count, context_.state().tuning()));
    const auto bits = static_cast<uint>(std::bit_width(largest_item));
    Commands commands(context_, "collide sort");
    // The sort is stable: it sorts by the second items, then by the first ones.
    RadixSort::Pairs pairs{{found.second}, {found.first}}, spare = columns(spare_, found.count);
    for (int column = 0; column < 2; ++column) {
        const RadixSort::Pairs sorted =
            sort_.record(commands, pairs, spare, counters_.ref<uint>(), static_cast<uint>(found.count), bits);
        if (sorted.keys.address != pairs.keys.address) std::swap(pairs, spare);
        std::swap(pairs.keys, pairs.values);
    }
    commands.submit();
    const bool is_in_spare = pairs.keys.address - spare_.address() < spare_.bytes();
    return {pairs.values.address, pairs.keys.address, found.count, is_in_spare ? &spare_ : &pairs_};
}

}  // namespace twinray
