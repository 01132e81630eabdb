// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "swtlas/structures.h"

namespace twinray {

struct CompressedCheck {
    std::vector<std::string> violations;  // one sentence each, at most 20
    std::vector<uint> used;               // records that are reached from the root's
};

// Walks a tree of layout compressed4 from records[0] and checks what traversal relies on: every leaf is reached exactly
// once, no record twice, nodes have two to four children, the planes of a child lie outside of what is below it by more
// than traversal's rounding, and the depth is within what its stack is made for. leaf_boxes[i] is the box of primitive
// or instance i; one that is empty may lie anywhere.
CompressedCheck check_compressed(std::span<const CompressedRecord> records, std::span<const LeafBox> leaf_boxes);

}  // namespace twinray
