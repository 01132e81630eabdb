// SPDX-License-Identifier: MIT
// What traversal and refits rely on in a tree of records, checked on the host.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "swtlas/check.h"
#include "swtlas/structures.h"

namespace twinray {

struct CompressedCheck {
    std::vector<std::string> violations;  // one sentence each, at most 20
    uint depth = 0;                       // nodes on the longest path
    uint width = 0;                       // how many children a node may have; 0: there is no node
    double sah = 0;                       // the surface-area cost, see surface_area.h, of the boxes as rays meet them
};

// Walks a tree of a layout of records from records[0] and checks what traversal and refits rely on: `bvh` has
// the box of all leaves, every leaf is reached exactly once, no record twice, those that are not reached are none,
// nodes have two children at least and are all of the width of the root, the planes of a child lie outside of what is
// below it by more than traversal's rounding, and the depth is within what its stack is made for. leaf_boxes[i] is the
// box of primitive or instance i; one that is empty may lie anywhere.
CompressedCheck check_compressed(const Bvh& bvh, std::span<const CompressedRecord> records,
                                 std::span<const LeafBox> leaf_boxes);

}  // namespace twinray
