// SPDX-License-Identifier: MIT
#include "tree.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <string>

#include "read_nodes.spv.h"

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

namespace {

struct Args {  // as the kernel declares them
    std::uint64_t accel;
    Ref<BvhNode> nodes;
    Ref<CompressedRecord> records;
    Uints primitives;
    uint count;
};

void require(bool holds, const std::string& what) {
    if (!holds) throw Error("the engine's tree differs: " + what);
}

// [read]
// T is BvhNode or CompressedRecord.
template <class T>
std::pair<std::vector<T>, std::vector<uint>> read(Context& context, const Mesh& mesh, Layout layout, uint count) {
    SwTlas accel(context, {.layout = layout});
    accel.push(mesh);
    accel.sync();
    const Kernel<Args> kernel(context, {.name = "read nodes", .spirv = read_nodes_spirv});
    const Buffer items(context, {.name = "items", .bytes = count * sizeof(T)});
    const Buffer primitives(context, {.name = "primitives", .bytes = count * sizeof(uint)});
    Args args{accel.view().scene, {}, {}, primitives.ref<uint>(), count};
    if constexpr (std::same_as<T, BvhNode>)
        args.nodes = items.ref<T>();
    else
        args.records = items.ref<T>();
    Commands commands(context, "read nodes");
    kernel.dispatch(commands, args, count);
    commands.submit();
    return {download<T>(context, items, count), download<uint>(context, primitives, count)};
}
// [/read]

bool same(const Bounds& box, vec3 lo, vec3 hi) { return box.lo == lo && box.hi == hi; }

// [wide]
// Returns all triangles below a record, sorted.
std::vector<uint> below(std::span<const CompressedRecord> records, uint record) {
    const uint word = records[record].a.w;
    if (word & LEAF_BIT) return {word & ~LEAF_BIT};
    std::vector<uint> triangles;
    for (uint i = 0; i < word >> 26; ++i)
        std::ranges::copy(below(records, (word & 0x3ffffffu) + i), std::back_inserter(triangles));
    std::ranges::sort(triangles);
    return triangles;
}
// [/wide]

}  // namespace

// [binary]
void check_binary(Context& context, const Mesh& mesh, const Sorted& sorted, std::span<const Node> nodes, int root) {
    const auto [theirs, primitives] =
        read<BvhNode>(context, mesh, Layout::bvh2, static_cast<uint>(mesh.triangles.size()));
    require(primitives == sorted.order, "the order of triangles");
    const std::vector<Bounds> boxes = boxes_of(mesh);
    std::vector<int> open = {root};
    while (!open.empty()) {
        const auto i = static_cast<std::size_t>(open.back());
        open.pop_back();
        const uint references[] = {theirs[i].child0, theirs[i].child1};
        for (std::size_t side = 0; side < 2; ++side) {
            const int child = nodes[i].children[side];
            const bool is_leaf = child < 0;
            const uint expected = is_leaf ? LEAF_BIT | static_cast<uint>(~child) : static_cast<uint>(child);
            require(references[side] == expected, "child " + std::to_string(side) + " of node " + std::to_string(i));
            const Bounds& box = is_leaf ? boxes[sorted.order[std::size_t(~child)]] : nodes[std::size_t(child)].box;
            require(side == 0 ? same(box, theirs[i].lo0, theirs[i].hi0) : same(box, theirs[i].lo1, theirs[i].hi1),
                    "the box of child " + std::to_string(side) + " of node " + std::to_string(i));
            if (!is_leaf) open.push_back(child);
        }
    }
}
// [/binary]

std::size_t check_wide(Context& context, const Mesh& mesh, const Sorted& sorted, std::span<const Node> nodes) {
    // The most that so many triangles can need; unused ones are left empty.
    const uint count = static_cast<uint>((5 * mesh.triangles.size() - 1) / 3);
    const std::vector<CompressedRecord> records =
        read<CompressedRecord>(context, mesh, Layout::compressed4, count).first;
    std::size_t compared = 1;
    std::vector<std::pair<std::size_t, uint>> open = {{0, 0}};  // ours and theirs
    while (!open.empty()) {
        const auto [node, record] = open.back();
        open.pop_back();
        const uint word = records[record].a.w;
        require(!(word & LEAF_BIT) && word >> 26 == nodes[node].children.size(),
                "the children of record " + std::to_string(record));
        for (uint i = 0; i < word >> 26; ++i, ++compared) {
            const int child = nodes[node].children[i];
            const uint at = (word & 0x3ffffffu) + i;
            std::vector<uint> ours = {};
            for (int k = child < 0 ? ~child : nodes[std::size_t(child)].first;
                 k <= (child < 0 ? ~child : nodes[std::size_t(child)].last); ++k)
                ours.push_back(sorted.order[std::size_t(k)]);
            std::ranges::sort(ours);
            require(below(records, at) == ours, "the triangles below record " + std::to_string(at));
            if (child >= 0) open.push_back({std::size_t(child), at});
        }
    }
    return compared;
}
