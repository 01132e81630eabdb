// SPDX-License-Identifier: MIT
// Boxes in the order of a Hilbert curve.
#pragma once

#include "engine/accel/world_bound.h"
#include "engine/core/device_list.h"
#include "engine/core/radix_sort.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/collide/box_tree.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(TreeBox) == 32);

// Sorts boxes on the GPU by where their centres lie along a Hilbert curve (shaders/collide/codes.comp); empty ones come
// first. Its memory grows with the largest count so far and is used again.
class HilbertOrder {
  public:
    explicit HilbertOrder(Context& context);

    // Makes room.
    void prepare(std::size_t count);
    // The numbers of the boxes in that order, which depends on the boxes alone; valid until the next call.
    Uints record(Commands& commands, Ref<TreeBox> boxes, uint count) const;
    std::uint64_t bytes() const { return scratch_.bytes() + bits_.bytes(); }

  private:
    Context& context_;
    Kernel<HilbertOrderArgs> centers_, codes_;
    RadixSort sort_;
    Buffer scratch_, bits_;
};

}  // namespace twinray
