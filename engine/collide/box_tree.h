// SPDX-License-Identifier: MIT
// A tree of boxes, built on the GPU: see shaders/collide/box_tree.h.
#pragma once

#include "engine/accel/world_bound.h"
#include "engine/core/device_list.h"
#include "engine/core/radix_sort.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/collide/box_tree.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(TreeBox) == 32);

// Sorts boxes on the GPU by the places of their centres along a Hilbert curve (shaders/collide/codes.comp); empty ones
// come first. Its memory grows with the largest count so far and is used again.
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

}  // namespace twinray
