// SPDX-License-Identifier: MIT
// Checks on the host the properties of a built tree that traversal and refits rely on.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "swtlas/structures.h"

namespace twinray {

struct TreeCheck {
    std::vector<std::string> violations;  // one sentence each, at most 20
    uint depth = 0;                       // inner nodes on the longest path
    uint width = 0;                       // how many children a node may have; 0: there is no node
    double sah = 0;                       // the surface-area cost, see surface_area.h, of the boxes as rays meet them
};

// Checks a tree of layout bvh2: every leaf and every inner node is reached exactly once, every child's box is the union
// of the boxes below it (so it contains those, exactly), nodes know their edges, and the depth is within the limit of a
// traversal's stack. leaf_boxes[i] is the box of the leaf that reference LEAF_BIT | i names.
TreeCheck check_tree(const Bvh& bvh, std::span<const BvhNode> nodes, std::span<const LeafBox> leaf_boxes);

// Checks a tree of any other layout, from records[0]: `bvh` has the box of all leaves, every leaf is reached exactly
// once, no record twice, unreached records are none, nodes have two children at least and are all of the width of the
// root, the planes of a child are outside of everything below it by more than traversal's rounding, and the depth is
// within the limit of its stack. leaf_boxes[i] is the box of primitive or instance i; an empty one may be anywhere.
TreeCheck check_tree(const Bvh& bvh, std::span<const CompressedRecord> records, std::span<const LeafBox> leaf_boxes);

}  // namespace twinray
