// SPDX-License-Identifier: MIT
// A tree of boxes, built on the GPU: see shaders/collide/box_tree.h.
#pragma once

#include "engine/collide/hilbert_order.h"

namespace twinray {

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
    Context& context_;
    Kernel<BoxTreeArgs> leaves_, level_;
    HilbertOrder order_;
    Buffer boxes_, nodes_;
    uint count_ = 0;
};

}  // namespace twinray
