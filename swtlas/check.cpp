// SPDX-License-Identifier: MIT
#include "swtlas/check.h"

#include <algorithm>

#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr uint max_depth = DEEPEST_TREE;

bool same(vec3 a, vec3 b) { return a == b; }

double half_area(const LeafBox& box) {
    if (!is_active(box)) return 0;
    const dvec3 size = dvec3(box.hi) - dvec3(box.lo);
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

class BinaryWalk {
  public:
    BinaryWalk(std::span<const BvhNode> nodes, std::span<const LeafBox> leaf_boxes, TreeCheck& result)
        : nodes_(nodes),
          leaf_boxes_(leaf_boxes),
          result_(result),
          seen_nodes_(nodes.size()),
          seen_leaves_(leaf_boxes.size()) {}

    struct Below {
        LeafBox box = empty_box();
        uint leaves = 0;
        uint height = 0;
    };

    Below visit(uint reference, uint depth, uint edge) {
        result_.depth = std::max(result_.depth, depth);
        if (depth > max_depth) return violated(text("depth exceeds ", max_depth)), Below{};
        if (reference & LEAF_BIT) return visit_leaf(reference & ~LEAF_BIT);
        if (reference >= nodes_.size()) return violated(text("node ", reference, " of ", nodes_.size())), Below{};
        if (seen_nodes_[reference]) return violated(text("node ", reference, " is reached twice")), Below{};
        seen_nodes_[reference] = true;
        if (const uint told = nodes_[reference].below0; told != edge)
            violated(text("node ", reference, ": its edge is ", edge, ", not ", told));
        return visit_node(reference, depth);
    }

    void finish(const Bvh& bvh, const Below& all) {
        if (!same(all.box.lo, bvh.lo) || !same(all.box.hi, bvh.hi))
            violated("the root's box is not the union of the leaves");
        if (all.height > DEEPEST_TREE) violated(text("the tree has ", all.height, " levels"));
        for (std::size_t i = 0; i < seen_leaves_.size(); ++i)
            if (!seen_leaves_[i]) violated(text("leaf ", i, " is not reached"));
        for (std::size_t i = 0; i < seen_nodes_.size(); ++i)
            if (!seen_nodes_[i]) violated(text("node ", i, " is not reached"));
        if (const double root = half_area(all.box); root > 0) result_.sah = area_ / root;
    }

    void violated(std::string sentence) {
        if (result_.violations.size() < max_violations) result_.violations.push_back(std::move(sentence));
    }

  private:
    Below visit_leaf(uint leaf) {
        if (leaf >= leaf_boxes_.size()) return violated(text("leaf ", leaf, " of ", leaf_boxes_.size())), Below{};
        if (seen_leaves_[leaf]) violated(text("leaf ", leaf, " is reached twice"));
        seen_leaves_[leaf] = true;
        return {leaf_boxes_[leaf], 1, 0};
    }

    Below visit_node(uint index, uint depth) {
        const BvhNode& node = nodes_[index];
        const Below a = visit(node.child0, depth + 1, make_edge(index, 0));
        const Below b = visit(node.child1, depth + 1, make_edge(index, 1));
        if (!same(a.box.lo, node.lo0) || !same(a.box.hi, node.hi0))
            violated(text("node ", index, ": box 0 is not the union of what is below"));
        if (!same(b.box.lo, node.lo1) || !same(b.box.hi, node.hi1))
            violated(text("node ", index, ": box 1 is not the union of what is below"));
        area_ += half_area(a.box) + half_area(b.box);
        return {
            {min(a.box.lo, b.box.lo), max(a.box.hi, b.box.hi)}, a.leaves + b.leaves, 1 + std::max(a.height, b.height)};
    }

    std::span<const BvhNode> nodes_;
    std::span<const LeafBox> leaf_boxes_;
    TreeCheck& result_;
    std::vector<bool> seen_nodes_, seen_leaves_;
    double area_ = 0;
};

}  // namespace

TreeCheck check_tree(const Bvh& bvh, std::span<const BvhNode> nodes, std::span<const LeafBox> leaf_boxes) {
    TreeCheck result;
    BinaryWalk walk(nodes, leaf_boxes, result);
    if (bvh.leaf_count != leaf_boxes.size())
        walk.violated(text("the tree has ", bvh.leaf_count, " leaves, not ", leaf_boxes.size()));
    if (leaf_boxes.empty()) {
        if (bvh.root != NOTHING) walk.violated("an empty tree has a root");
        return result;
    }
    walk.finish(bvh, walk.visit(bvh.root, 0, 0));
    return result;
}

}  // namespace twinray
