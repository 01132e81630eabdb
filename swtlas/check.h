// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "swtlas/structures.h"

namespace twinray {

inline constexpr std::size_t max_violations = 20;  // that a check tells

struct TreeCheck {
    std::vector<std::string> violations;  // one sentence each, at most 20
    uint depth = 0;                       // inner nodes on the longest path
    double sah = 0;  // surface area heuristic: sum of inner child areas over the root's (node cost 1, leaf cost 1)
};

// Walks a built tree and checks what traversal relies on: every leaf and every inner node is reached exactly once,
// every child's box is the union of what lies below it (so it contains that, exactly), its leaves are counted right,
// the depth is within what the traversal's stack is made for. leaf_boxes[i] is the box of the leaf that reference
// LEAF_BIT | i names.
TreeCheck check_tree(const Bvh& bvh, std::span<const BvhNode> nodes, std::span<const LeafBox> leaf_boxes);

}  // namespace twinray
