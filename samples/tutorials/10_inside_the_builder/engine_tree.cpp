// SPDX-License-Identifier: MIT
#include "engine_tree.h"

#include <algorithm>
#include <string>

#include "read_nodes.spv.h"

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
