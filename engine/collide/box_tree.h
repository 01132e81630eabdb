// SPDX-License-Identifier: MIT
// A tree of boxes, built on the GPU: see shaders/shared/box_tree.h.
#pragma once

#include "engine/accel/world_bound.h"
#include "engine/core/radix_sort.h"

namespace twinray {
#include "engine/core/bridge_begin.h"
#include "shaders/shared/box_tree.h"
#include "engine/core/bridge_end.h"

static_assert(sizeof(TreeBox) == 32);

// What kernels need to search a tree: valid until the next prepare().
struct BoxTreeView {
    Ref<TreeBox> nodes;
    uint leaf_begin = 1;
    uint count = 0;

    Ref<TreeBox> leaves() const { return {nodes.address + leaf_begin * sizeof(TreeBox)}; }
};

// Its memory grows with the largest count so far and is used again.
class BoxTree {
  public:
    static constexpr std::size_t max_count = 1u << 28;

    explicit BoxTree(Context& context);

    // Makes room for `count` boxes of which a tree is to be made and gives where to write them, in any order; empty
    // ones (lo > hi) are never found. Throws Error above max_count.
    Ref<TreeBox> prepare(std::size_t count);
    const Buffer& boxes() const { return boxes_; }  // where they are written
    // Sorts the boxes that earlier passes have written and builds the tree. Depends on the boxes alone.
    void record(Commands& commands) const;
    BoxTreeView view() const;
    std::uint64_t bytes() const;

  private:
    Uints record_order(Commands& commands, BoxTreeArgs args) const;

    Context& context_;
    Kernel<BoxTreeArgs> centers_, codes_, leaves_, level_;
    RadixSort sort_;
    Buffer boxes_, nodes_, scratch_, bits_;
    uint count_ = 0;
};

}  // namespace twinray
