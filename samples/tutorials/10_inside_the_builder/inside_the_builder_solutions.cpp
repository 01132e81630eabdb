// SPDX-License-Identifier: MIT
// Solutions of the exercises.
#include <cmath>
#include <iostream>

#include "tree.h"

// [exercise1]
// The areas of all boxes below the root, including leaves, over the root's: the boxes that a long random ray enters.
double cost(std::span<const Node> nodes, int root, std::span<const Bounds> boxes, const Sorted& sorted) {
    const auto area = [](const Bounds& box) {
        const dvec3 size(box.size());
        return size.x * size.y + size.y * size.z + size.z * size.x;
    };
    double sum = 0;
    std::vector<int> open = {root};
    while (!open.empty()) {
        const Node& node = nodes[std::size_t(open.back())];
        open.pop_back();
        for (const int child : node.children) {
            sum += area(child < 0 ? boxes[sorted.order[std::size_t(~child)]] : nodes[std::size_t(child)].box);
            if (child >= 0) open.push_back(child);
        }
    }
    return sum / area(nodes[std::size_t(root)].box);
}
// The cost that the engine measures of its own tree. It does so once vertices have been given anew.
double cost_of_engine(Context& context, const Mesh& mesh, Layout layout) {
    SwTlas accel(context, {.layout = layout});
    const AccelHandle handle = accel.push(mesh);
    accel.sync();
    accel.update_vertices(handle, mesh.positions);
    accel.sync();
    return accel.sah(handle).value();
}

// [exercise2]
// Uses triangles with one centre: all codes are equal.
int depth_of_equal_codes(uint count) {
    const Bounds same{vec3(0), vec3(1, 1, 0)};
    const std::vector<Bounds> boxes(count, same);
    const Sorted sorted = morton_order(boxes);
    std::vector<Node> nodes;
    int depth = 0;
    for (int at = radix_tree(sorted, boxes, nodes); at >= 0; at = nodes[std::size_t(at)].children[0]) ++depth;
    return depth;
}
// [/exercise2]

int main() try {
    const Mesh scene = make_scene(32, 5);
    const std::vector<Bounds> boxes = boxes_of(scene);
    const Sorted sorted = morton_order(boxes);
    std::vector<Node> binary;
    const int root = radix_tree(sorted, boxes, binary);
    Context context;
    const double ours = cost(binary, root, boxes, sorted), theirs = cost_of_engine(context, scene, Layout::bvh2);
    const std::vector<Node> four = collapse(binary, root, 4);
    std::cout << "1: binary tree " << ours << ", by the engine " << theirs << "; tree of four "
              << cost(four, 0, boxes, sorted) << '\n';
    if (std::abs(ours / theirs - 1) > 0x1p-16) throw Error("the engine's cost differs");
    const int depth = depth_of_equal_codes(32);
    std::cout << "2: 32 equal codes make a tree of " << depth << " levels\n";
    if (depth != 5) throw Error("the tree of equal codes is not balanced");
    // [exercise3]
    for (const std::size_t width : {2, 4, 8})
        std::cout << "3: nodes of up to " << width << " children: " << collapse(binary, root, width).size() << '\n';
    // [/exercise3]
    if (collapse(binary, root, 2).size() != 31) throw Error("32 leaves need 31 binary nodes");
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
