// SPDX-License-Identifier: MIT
// A tree of the largest height.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "validation/cpu_reference/reference.h"

namespace twinray::test {

// A binary tree of the largest height: its spine forks into a fat tree of four leaves and all that is farther in. If
// boxes shrink inwards, the taller part is always the smaller one. Leaf 0 is the innermost, followed by four per fork.
struct TallTree {
    static constexpr uint forks = DEEPEST_TREE - 2;
    static constexpr uint leaves = 4 * forks + 1;

    std::vector<LeafBox> boxes;
    reference::Hierarchy tree = {};

    explicit TallTree(std::vector<LeafBox> leaf_boxes) : boxes(std::move(leaf_boxes)) {
        Part all = leaf(0);
        for (uint i = 0; i < forks; ++i)
            all = join(all, join(join(leaf(4 * i + 1), leaf(4 * i + 2)), join(leaf(4 * i + 3), leaf(4 * i + 4))));
        tree.root = all.reference;
        tree.box = all.box;
    }

    // Returns the tree of a file or a check, in layouts of records.
    Bvh bvh_of_records() const { return {tree.box.lo, tree.box.hi, {}, 0, leaves}; }

  private:
    struct Part {
        uint reference;
        LeafBox box;
        uint subtree;
    };

    Part leaf(uint i) const { return {LEAF_BIT | i, boxes[i], subtree_info(1, 0)}; }
    Part join(const Part& a, const Part& b) {
        tree.nodes.push_back({a.box.lo, a.reference, a.box.hi, a.subtree, b.box.lo, b.reference, b.box.hi, b.subtree});
        return {static_cast<uint>(tree.nodes.size() - 1),
                {min(a.box.lo, b.box.lo), max(a.box.hi, b.box.hi)},
                subtree_info(leaves_in(a.subtree) + leaves_in(b.subtree),
                             1 + std::max(height_in(a.subtree), height_in(b.subtree)))};
    }
};

}  // namespace twinray::test
