// SPDX-License-Identifier: MIT
// The three steps of a build, in plain code: Morton order, the binary radix tree, the wide tree.
#pragma once

#include <span>
#include <vector>

#include "twinray/glsl/cpp.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/bvh.h"
#include "shaders/shared/morton.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray

using namespace twinray;

// A node of either tree. The binary one has two children, the wide one up to four.
// [node]
struct Node {
    Bounds box;
    std::vector<int> children;  // index of a node, or below 0: ~ position in the Morton order
    int first = 0, last = 0;    // the positions below it
};
// [/node]

struct Sorted {
    std::vector<uint> codes;  // in order
    std::vector<uint> order;  // which triangle is at which position
};

std::vector<Bounds> boxes_of(const Mesh& mesh);
Sorted morton_order(std::span<const Bounds> boxes);
// Node i is split behind position i, like the engine's; returns the root.
int radix_tree(const Sorted& sorted, std::span<const Bounds> boxes, std::vector<Node>& nodes);
// Node 0 is the root.
std::vector<Node> collapse(std::span<const Node> binary, int root, std::size_t width);
