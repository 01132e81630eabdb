// SPDX-License-Identifier: MIT
#include "tree.h"

#include <algorithm>
#include <bit>
#include <numeric>

std::vector<Bounds> boxes_of(const Mesh& mesh) {
    std::vector<Bounds> boxes;
    for (const uvec3& t : mesh.triangles) {
        boxes.emplace_back();
        for (const uint vertex : {t.x, t.y, t.z}) boxes.back().include(mesh.positions[vertex]);
    }
    return boxes;
}

// [morton]
Sorted morton_order(std::span<const Bounds> boxes) {
    Bounds around;  // all centres
    for (const Bounds& box : boxes) around.include(box.lo * 0.5f + box.hi * 0.5f);
    std::vector<uint> codes;
    for (const Bounds& box : boxes) codes.push_back(morton_code(box.lo * 0.5f + box.hi * 0.5f, around.lo, around.hi));
    Sorted sorted;
    sorted.order.resize(boxes.size());
    std::iota(sorted.order.begin(), sorted.order.end(), 0u);
    std::ranges::stable_sort(sorted.order, {}, [&](uint triangle) { return codes[triangle]; });
    for (const uint triangle : sorted.order) sorted.codes.push_back(codes[triangle]);
    return sorted;
}
// [/morton]

namespace {

// [split]
// The highest bit in which two neighbours differ; if their codes are equal, that of their positions.
int split_between(const Sorted& sorted, int i) {
    const auto code = [&](int at) { return std::uint64_t{sorted.codes[std::size_t(at)]} << 32 | std::uint64_t(at); };
    return 63 - std::countl_zero(code(i) ^ code(i + 1));
}

// A range of the order is cut where the highest bit changes: there the curve leaves one half of the cell for the other.
int cut(const Sorted& sorted, int first, int last) {
    int split = first;
    for (int i = first; i < last; ++i)
        if (split_between(sorted, i) > split_between(sorted, split)) split = i;
    return split;
}
// [/split]

// [radix]
// Builds the subtree of a range and returns its reference, as in Node::children.
int build(const Sorted& sorted, std::span<const Bounds> boxes, std::vector<Node>& nodes, int first, int last) {
    if (first == last) return ~first;
    const int split = cut(sorted, first, last);
    Node node;
    node.first = first;
    node.last = last;
    for (const auto& [from, to] : {std::pair{first, split}, std::pair{split + 1, last}}) {
        const int child = build(sorted, boxes, nodes, from, to);
        node.children.push_back(child);
        node.box.include(child < 0 ? boxes[sorted.order[std::size_t(~child)]] : nodes[std::size_t(child)].box);
    }
    nodes[std::size_t(split)] = node;
    return split;
}
// [/radix]

float area(const Bounds& box) {
    const vec3 size = box.size();
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

}  // namespace

int radix_tree(const Sorted& sorted, std::span<const Bounds> boxes, std::vector<Node>& nodes) {
    nodes.assign(boxes.size() - 1, {});
    return build(sorted, boxes, nodes, 0, static_cast<int>(boxes.size()) - 1);
}

// [collapse]
// A wide node takes the children of a binary one, then opens the child with the largest box until it has `width`: a
// large box is likely to be entered anyway, so that its own step is saved.
std::vector<Node> collapse(std::span<const Node> binary, int root, std::size_t width) {
    std::vector<Node> wide = {binary[std::size_t(root)]};
    for (std::size_t at = 0; at < wide.size(); ++at) {
        std::vector<int> children = wide[at].children;  // in the binary tree
        while (children.size() < width) {
            const auto largest = std::ranges::max_element(
                children, {}, [&](int child) { return child < 0 ? -1.0f : area(binary[std::size_t(child)].box); });
            if (*largest < 0) break;  // leaves alone
            const Node& opened = binary[std::size_t(*largest)];
            *largest = opened.children[0];
            children.push_back(opened.children[1]);
        }
        for (int& child : children) {
            if (child < 0) continue;
            wide.push_back(binary[std::size_t(child)]);
            child = static_cast<int>(wide.size()) - 1;
        }
        wide[at].children = children;
    }
    return wide;
}
// [/collapse]
