// SPDX-License-Identifier: MIT
#include "swtlas/check_compressed.h"

#include <algorithm>

#include "engine/core/error.h"

namespace twinray {
namespace {

constexpr double least_margin = 1.0 / 512;  // of a cell: half of what is added, the rest may round

double half_area(glm::dvec3 lo, glm::dvec3 hi) {
    const glm::dvec3 size = hi - lo;
    return lo.x <= hi.x ? size.x * size.y + size.y * size.z + size.z * size.x : 0;
}

// The planes of the boxes of a node's children, exactly.
struct Planes {
    glm::dvec3 lo, hi;
    glm::dvec3 cell;
};

Planes planes_of(const CompressedRecord& node, uint child) {
    const auto plane = [&](uint word) { return static_cast<double>(word >> 8 * child & 0xff); };
    const glm::dvec3 origin(grid_origin(node));
    const glm::dvec3 cell(grid_cell(node));
    return {origin + cell * glm::dvec3(plane(node.b.x), plane(node.b.z), plane(node.c.x)),
            origin + cell * glm::dvec3(plane(node.b.y), plane(node.b.w), plane(node.c.y)), cell};
}

class CompressedWalk {
  public:
    CompressedWalk(std::span<const CompressedRecord> records, std::span<const LeafBox> leaf_boxes,
                   CompressedCheck& result)
        : records_(records),
          leaf_boxes_(leaf_boxes),
          result_(result),
          seen_records_(records.size()),
          seen_leaves_(leaf_boxes.size()) {
        result_.boxes.assign(records.size(), empty_box());
    }

    LeafBox visit(uint index, uint depth) {
        if (index >= records_.size()) return violated(text("record ", index, " of ", records_.size()));
        if (seen_records_[index]) return violated(text("record ", index, " is reached twice"));
        seen_records_[index] = true;
        result_.used.push_back(index);
        return result_.boxes[index] = visit_record(index, depth);
    }

    void finish(const Bvh& bvh, const LeafBox& all) {
        if (bvh.root != 0) violated(text("the root is record ", bvh.root, ", not 0"));
        if (bvh.lo != all.lo || bvh.hi != all.hi) violated("the root's box is not the union of the leaves");
        for (std::size_t i = 0; i < seen_records_.size(); ++i)
            if (!seen_records_[i] && (is_leaf(records_[i]) || children_in(records_[i]) != 0))
                violated(text("record ", i, " is not reached, and not none"));
        if (const double root = half_area(all.lo, all.hi); root > 0) {
            result_.sah = area_ / root;
            result_.full_sah = full_area_ / root;
        }
        for (std::size_t i = 0; i < seen_leaves_.size(); ++i)
            if (!seen_leaves_[i]) violated(text("leaf ", i, " is not reached"));
    }

    LeafBox violated(std::string sentence) {
        if (result_.violations.size() < max_violations) result_.violations.push_back(std::move(sentence));
        return empty_box();
    }

  private:
    LeafBox visit_record(uint index, uint depth) {
        const CompressedRecord& record = records_[index];
        if (is_leaf(record)) return visit_leaf(index_in(record));
        if (depth >= DEEPEST_RECORDS) return violated(text("depth exceeds ", DEEPEST_RECORDS));
        result_.depth = std::max(result_.depth, depth + 1);
        return visit_node(index, depth);
    }

    LeafBox visit_leaf(uint leaf) {
        if (leaf >= leaf_boxes_.size()) return violated(text("leaf ", leaf, " of ", leaf_boxes_.size()));
        if (seen_leaves_[leaf]) violated(text("leaf ", leaf, " is reached twice"));
        seen_leaves_[leaf] = true;
        return leaf_boxes_[leaf];
    }

    LeafBox visit_node(uint index, uint depth) {
        const CompressedRecord& node = records_[index];
        const uint count = children_in(node);
        if (count < 2 || count > 4) return violated(text("record ", index, " has ", count, " children"));
        LeafBox all = empty_box();
        for (uint child = 0; child < count; ++child) {
            const LeafBox below = visit(first_child_of(node) + child, depth + 1);
            const Planes planes = planes_of(node, child);
            area_ += half_area(planes.lo, planes.hi);
            full_area_ += half_area(below.lo, below.hi);
            if (!is_active(below)) continue;
            for (int axis = 0; axis < 3; ++axis)
                if (planes.lo[axis] + least_margin * planes.cell[axis] > double{below.lo[axis]} ||
                    planes.hi[axis] - least_margin * planes.cell[axis] < double{below.hi[axis]})
                    violated(text("record ", index, ": child ", child, " from ", below.lo[axis], " to ", below.hi[axis],
                                  " lies in planes ", planes.lo[axis], " and ", planes.hi[axis]));
            all = {min(all.lo, below.lo), max(all.hi, below.hi)};
        }
        return all;
    }

    std::span<const CompressedRecord> records_;
    std::span<const LeafBox> leaf_boxes_;
    CompressedCheck& result_;
    std::vector<bool> seen_records_, seen_leaves_;
    double area_ = 0, full_area_ = 0;
};

}  // namespace

CompressedCheck check_compressed(const Bvh& bvh, std::span<const CompressedRecord> records,
                                 std::span<const LeafBox> leaf_boxes) {
    CompressedCheck result;
    CompressedWalk walk(records, leaf_boxes, result);
    if (bvh.leaf_count != leaf_boxes.size())
        walk.violated(text("the tree has ", bvh.leaf_count, " leaves, not ", leaf_boxes.size()));
    if (leaf_boxes.empty()) {
        if (bvh.root != NOTHING) walk.violated("an empty tree has a root");
        return result;
    }
    walk.finish(bvh, walk.visit(0, 0));
    return result;
}

}  // namespace twinray
