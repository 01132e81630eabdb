// SPDX-License-Identifier: MIT
// Finds pairs of boxes that overlap, on the device by a tree of boxes.
#pragma once

#include <twinray/queries.h>

#include <string>

#include "engine/collide/box_tree.h"
#include "engine/core/pace.h"

namespace twinray {

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
