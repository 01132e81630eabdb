#include "swtlas/tree.h"

#include <algorithm>

#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr std::size_t max_violations = 20;
constexpr double least_margin = 1.0 / 512;  // of a cell: half of the added margin, the rest may round

double half_area(dvec3 lo, dvec3 hi) {
    const dvec3 size = hi - lo;
    return lo.x <= hi.x ? size.x * size.y + size.y * size.z + size.z * size.x : 0;
}

// The common part of the walks of all layouts: T is the type of a tree's array.
template <class T>
class TreeWalk {
  public:
    TreeWalk(std::span<const T> items, std::span<const LeafBox> leaf_boxes)
        : items_(items), leaf_boxes_(leaf_boxes), seen_(items.size()), seen_leaves_(leaf_boxes.size()) {}

    // Returns false, and `bvh` is checked, if there is nothing to walk.
    bool begin(const Bvh& bvh) {
        if (leaf_boxes_.empty() && (bvh.root != NOTHING || bvh.leaf_count != 0))
            violated("an empty tree has a root or leaves");
        return !leaf_boxes_.empty();
    }

    TreeCheck finish(const Bvh& bvh, const LeafBox& all) {
        if (bvh.leaf_count != leaf_count_)
            violated(text("the tree has ", leaf_count_, " leaves, not ", bvh.leaf_count));
        if (bvh.lo != all.lo || bvh.hi != all.hi) violated("the root's box is not the union of the leaves");
        for (std::size_t i = 0; i < seen_leaves_.size(); ++i)
            if (!seen_leaves_[i]) violated(text("leaf ", i, " is not reached"));
        if (const double root = half_area(all.lo, all.hi); root > 0) result_.sah = area_ / root;
        return result();
    }

    TreeCheck result() { return std::move(result_); }

  protected:
    LeafBox violated(std::string sentence) {
        if (result_.violations.size() < max_violations) result_.violations.push_back(std::move(sentence));
        return empty_box();
    }

    LeafBox visit_leaf(uint primitive) {
        ++leaf_count_;
        return visit_primitive(primitive);
    }
    LeafBox visit_primitive(uint primitive) {
        if (primitive >= leaf_boxes_.size()) return violated(text("leaf ", primitive, " of ", leaf_boxes_.size()));
        if (seen_leaves_[primitive]) violated(text("leaf ", primitive, " is reached twice"));
        seen_leaves_[primitive] = true;
        return leaf_boxes_[primitive];
    }

    // Returns whether the item exists and is reached for the first time.
    bool enter(uint index, const char* what) {
        if (index >= items_.size()) return violated(text(what, ' ', index, " of ", items_.size())), false;
        if (seen_[index]) return violated(text(what, ' ', index, " is reached twice")), false;
        seen_[index] = true;
        return true;
    }

    std::span<const T> items_;
    std::span<const LeafBox> leaf_boxes_;
    TreeCheck result_;
    std::vector<bool> seen_, seen_leaves_;
    double area_ = 0;
    std::size_t leaf_count_ = 0;  // visited
};

class BinaryWalk : public TreeWalk<BvhNode> {
  public:
    using TreeWalk::TreeWalk;

    LeafBox visit(uint reference, uint depth, uint edge) {
        result_.depth = std::max(result_.depth, depth);
        if (depth > DEEPEST_TREE) return violated(text("depth exceeds ", DEEPEST_TREE));
        if (reference & LEAF_BIT) return visit_leaf(reference & ~LEAF_BIT);
        if (!enter(reference, "node")) return empty_box();
        const BvhNode& node = items_[reference];
        if (node.subtree0 != edge) violated(text("node ", reference, ": its edge is ", edge, ", not ", node.subtree0));
        result_.width = 2;
        const LeafBox a = visit(node.child0, depth + 1, make_edge(reference, 0));
        const LeafBox b = visit(node.child1, depth + 1, make_edge(reference, 1));
        if (a.lo != node.lo0 || a.hi != node.hi0)
            violated(text("node ", reference, ": box 0 is not the union of what is below"));
        if (b.lo != node.lo1 || b.hi != node.hi1)
            violated(text("node ", reference, ": box 1 is not the union of what is below"));
        area_ += half_area(a.lo, a.hi) + half_area(b.lo, b.hi);
        return {min(a.lo, b.lo), max(a.hi, b.hi)};
    }

    TreeCheck finish(const Bvh& bvh, const LeafBox& all) {
        for (std::size_t i = 0; i < seen_.size(); ++i)
            if (!seen_[i]) violated(text("node ", i, " is not reached"));
        return TreeWalk::finish(bvh, all);
    }
};

// The planes of the boxes of a node's children, exactly.
struct Planes {
    dvec3 lo, hi;
    dvec3 cell;
};

Planes planes_of(const CompressedRecord& node, const CompressedRecord& half_node, uint slot) {
    const auto plane = [&](uint word) { return static_cast<double>(word >> 8 * (slot & 3) & 0xff); };
    const dvec3 origin(grid_origin(node));
    const dvec3 cell(grid_cell(node));
    return {origin + cell * dvec3(plane(half_node.b.x), plane(half_node.b.z), plane(half_node.c.x)),
            origin + cell * dvec3(plane(half_node.b.y), plane(half_node.b.w), plane(half_node.c.y)), cell};
}

bool are_axes(uint axes) {
    return axes < 64 && (1u << axis_at(axes, 0) | 1u << axis_at(axes, 1) | 1u << axis_at(axes, 2)) == 7;
}

// A range of records, first to last; empty if the first is larger.
struct Span {
    uint first, last;
};

class CompressedWalk : public TreeWalk<CompressedRecord> {
  public:
    using TreeWalk::TreeWalk;

    LeafBox visit(uint index, uint depth) {
        if (!enter(index, "record")) return empty_box();
        const CompressedRecord& record = items_[index];
        below_ = {1, 0};
        if (is_leaf(record)) {
            const LeafBox box = visit_leaf(index_in(record));
            return is_pair(record) ? around_both(box, visit_primitive(second_index_in(record))) : box;
        }
        if (depth >= DEEPEST_RECORDS) return violated(text("depth exceeds ", DEEPEST_RECORDS));
        result_.depth = std::max(result_.depth, depth + 1);
        return visit_node(index, depth);
    }

    TreeCheck finish(const Bvh& bvh, const LeafBox& all) {
        if (bvh.root != 0) violated(text("the root is record ", bvh.root, ", not 0"));
        for (std::size_t i = 0; i < seen_.size(); ++i)
            if (!seen_[i] && (is_leaf(items_[i]) || children_in(items_[i]) != 0))
                violated(text("record ", i, " is not reached, and not none"));
        return TreeWalk::finish(bvh, all);
    }

  private:
    LeafBox visit_node(uint index, uint depth) {
        const CompressedRecord& node = items_[index];
        const uint width = is_wide_node(node) ? 8 : 4, count = children_in(node);
        if (result_.width == 0) result_.width = width;
        if (width != result_.width) return violated(text("record ", index, " is a node of ", width, " children"));
        if (count < 2 || count > width) return violated(text("record ", index, " has ", count, " children"));
        if (width == 8 && !has_second_half(index)) return violated(text("node ", index, " has no sound second half"));
        const CompressedRecord& second_half = items_[width == 8 ? index + 1 : index];
        const ChildSlots slots = child_slots(node, second_half);
        LeafBox all = empty_box();
        std::vector<Span> spans;
        for (uint slot = 0; slot < 8; ++slot)
            if (has_child(slots, slot)) {
                const LeafBox below = visit_child(slots, slot, depth);
                check_planes(index, planes_of(node, slot < 4 ? node : second_half, slot), below, slot);
                if (is_active(below)) all = {min(all.lo, below.lo), max(all.hi, below.hi)};
                if (below_.first <= below_.last) spans.push_back(below_);
            }
        check_apart(index, slots, std::move(spans));
        return all;
    }

    // Records below different children do not mix: a ray finds its way back to one by the starts of their own children.
    void check_apart(uint index, const ChildSlots& slots, std::vector<Span> spans) {
        std::ranges::sort(spans, {}, &Span::first);
        below_ = {slots.first, children_end(slots) - 1};
        for (std::size_t i = 0; i < spans.size(); ++i) {
            if (i > 0 && spans[i].first <= spans[i - 1].last)
                violated(text("records below the children of record ", index, " mix"));
            below_ = {std::min(below_.first, spans[i].first), std::max(below_.last, spans[i].last)};
        }
    }

    // Checks a node of eight: its slots hold as many children as it says.
    bool has_second_half(uint index) {
        if (index + 1 >= items_.size() || seen_[index + 1]) return false;
        seen_[index + 1] = true;
        const CompressedRecord& half = items_[index + 1];
        const uint slots = half.a.x & 0xff, nodes = half.a.x >> 8 & 0xff;
        return half.a.w == WIDE_BIT && half.a.y == 0 && half.a.z == 0 && are_axes(half.a.x >> 16) &&
               (nodes & ~slots) == 0 && static_cast<uint>(bitCount(slots)) == children_in(items_[index]);
    }

    LeafBox visit_child(const ChildSlots& slots, uint slot, uint depth) {
        const uint index = child_index(slots, slot);
        const bool is_node = (slots.mask >> slot & 0x100) != 0;
        if (result_.width == 8 && index < items_.size() && is_node == is_leaf(items_[index]))
            return violated(text("record ", index, is_node ? " is no node" : " is no leaf"));
        return visit(index, depth + 1);
    }

    void check_planes(uint index, const Planes& planes, const LeafBox& below, uint slot) {
        area_ += half_area(planes.lo, planes.hi);
        if (!is_active(below)) return;
        for (int axis = 0; axis < 3; ++axis)
            if (!(planes.lo[axis] + least_margin * planes.cell[axis] <= double{below.lo[axis]}) ||
                !(planes.hi[axis] - least_margin * planes.cell[axis] >= double{below.hi[axis]}))
                violated(text("record ", index, ": child ", slot, " from ", below.lo[axis], " to ", below.hi[axis],
                              " lies in planes ", planes.lo[axis], " and ", planes.hi[axis]));
    }

    Span below_{1, 0};  // records below the one that was visited last
};

}  // namespace

TreeCheck check_tree(const Bvh& bvh, std::span<const BvhNode> nodes, std::span<const LeafBox> leaf_boxes) {
    BinaryWalk walk(nodes, leaf_boxes);
    return walk.begin(bvh) ? walk.finish(bvh, walk.visit(bvh.root, 0, 0)) : walk.result();
}

TreeCheck check_tree(const Bvh& bvh, std::span<const CompressedRecord> records, std::span<const LeafBox> leaf_boxes) {
    CompressedWalk walk(records, leaf_boxes);
    return walk.begin(bvh) ? walk.finish(bvh, walk.visit(0, 0)) : walk.result();
}

}  // namespace twinray
