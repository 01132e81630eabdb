// SPDX-License-Identifier: MIT
// Shared by the CPU references of the kernels that make hierarchies.
#pragma once

#include "validation/cpu_reference/reference.h"

namespace twinray::reference {

struct SortedLeaves {
    std::span<const LeafBox> boxes;
    const Codes& codes;
    std::span<const uint> order;
    bool are_sorted;  // references count sorted leaves, else they are the leaf's own index

    uvec2 split_after(std::size_t position) const;
    // The range is first .. last, of more than one leaf.
    std::size_t highest_split(std::size_t first, std::size_t last) const;
    NodeChild leaf(std::size_t position) const;
    float scale() const;  // of areas
};

Hierarchy hierarchy_of(std::span<const BvhChild> halves, const NodeChild& root);

}  // namespace twinray::reference
