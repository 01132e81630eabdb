// A tree of boxes, built on the GPU: see shaders/collide/box_tree.h; and the search for pairs of boxes that overlap.
#pragma once

#include <string>

#include <twinray/queries.h>

#include "engine/accel/world_bound.h"
#include "engine/core/device_list.h"
#include "engine/core/radix_sort.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/collide/box_tree.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(TreeBox) == 32);

// Sorts boxes on the GPU by the places of their centres along a Hilbert curve (shaders/collide/hilbert_order.comp);
// empty ones come first. Its memory grows with the largest count so far and is used again.
class HilbertOrder {
  public:
    explicit HilbertOrder(Context& context);

    // Makes room.
    void prepare(std::size_t count);
    // Returns the numbers of the boxes in that order, which depends only on the boxes; valid until the next call.
    Uints record(Commands& commands, Ref<TreeBox> boxes, uint count) const;
    std::uint64_t bytes() const { return scratch_.bytes() + bits_.bytes(); }

  private:
    Context& context_;
    Kernel<HilbertOrderArgs> centers_, codes_;
    RadixSort sort_;
    Buffer scratch_, bits_;
};

// The data that kernels need to search a tree: valid until the next prepare().
struct BoxTreeView {
    Ref<TreeBox> nodes;
    uint leaf_begin = 1;
    uint count = 0;

    Ref<TreeBox> leaves() const { return {nodes.address + leaf_begin * sizeof(TreeBox)}; }
};

// The tree's memory grows with the largest count so far and is used again.
class BoxTree {
  public:
    static constexpr std::size_t max_count = 1u << 28;

    explicit BoxTree(Context& context);

    // Makes room for `count` boxes of a tree and returns the address where they must be written, in any order; empty
    // ones (lo > hi) are never found. Throws Error above max_count.
    Ref<TreeBox> prepare(std::size_t count);
    const Buffer& boxes() const { return boxes_; }  // their buffer
    // Sorts the boxes that earlier passes have written and builds the tree, which depends only on the boxes.
    void record(Commands& commands) const;
    BoxTreeView view() const;
    std::uint64_t bytes() const;

  private:
    Context& context_;
    Kernel<BoxTreeArgs> leaves_, level_;
    HilbertOrder order_;
    Buffer boxes_, nodes_;
    uint count_ = 0;
};

// Copies one column of them, `first` or `second`, to the host.
std::vector<uint> download(Context& context, const DevicePairs& pairs, std::uint64_t DevicePairs::*column);

// Finds the boxes of a tree that overlap given ones. Boxes are closed: those that touch overlap. The memory for pairs
// grows with the largest number found so far and is used again.
class PairSearch {
  public:
    static constexpr std::uint64_t most_pairs = 0xffffffffu;

    explicit PairSearch(Context& context);

    struct Query {
        BoxTreeView tree;
        Ref<TreeBox> boxes = {};  // null: the leaves of the tree, each pair of them once
        uint box_count = 0;
        bool other_groups = false;  // no pairs of boxes of one group
    };
    // Returns the items of all pairs: (lower, higher) within a tree, else (query, leaf), in no order. Submits and
    // waits. If there are more than max_pairs(), throws Error, beginning with `action`, that names their number.
    DevicePairs find(const Query& query, const std::string& action);
    // The same, ascending by (first, second); no item is above `largest_item`.
    DevicePairs find_sorted(const Query& query, uint largest_item, const std::string& action);
    // Returns the number that find() would find, without memory and without limit.
    std::uint64_t count(const Query& query) { return run(query, 0, query.other_groups ? 0 : SEARCH_COUNT); }
    bool any(const Query& query) { return run(query, 0, SEARCH_ANY) != 0; }

    // A pair takes 8 bytes of device memory, and 16 while they are sorted. Default: 2^27 pairs.
    std::uint64_t max_pairs() const { return max_pairs_; }
    // Throws Error above 2^32 - 1.
    void set_max_pairs(std::uint64_t count);
    std::uint64_t bytes() const { return pairs_.bytes() + spare_.bytes() + counters_.bytes(); }

  private:
    std::uint64_t run(const Query& query, std::uint64_t capacity, uint flags);
    std::uint64_t capacity() const { return pairs_.bytes() / (2 * sizeof(uint)); }
    void reserve(std::uint64_t count);
    static RadixSort::Pairs columns(const Buffer& buffer, std::uint64_t count);

    Context& context_;
    Kernel<PairSearchArgs> kernel_;
    RadixSort sort_;
    Buffer pairs_, spare_, counters_, total_, readback_;
    Pace pace_;
    std::uint64_t max_pairs_ = default_max_pairs;
};

}  // namespace twinray
