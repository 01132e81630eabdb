// SPDX-License-Identifier: MIT
// The scene for which the tutorial builds a tree, and the three steps of a build, in plain code: Morton order, the
// binary radix tree, the wide tree.
#pragma once

#include <random>
#include <span>
#include <vector>

#include <twinray/geometry.h>
#include <twinray/tlas.h>

#include "twinray/glsl/cpp.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/bvh.h"
#include "shaders/shared/morton.h"
#include "twinray/glsl/cpp_end.h"
}  // namespace twinray

using namespace twinray;

// [scene]
// Small triangles in the square [0, 1]^2 of the plane z = 0, many in one corner.
inline Mesh make_scene(uint count, uint seed) {
    std::mt19937 random(seed);
    const auto number = [&] { return static_cast<float>(random() >> 8) / 16777216.0f; };
    Mesh scene;
    scene.name = "triangles";
    for (uint i = 0; i < count; ++i) {
        const float reach = i % 3 == 0 ? 0.35f : 0.9f;
        const float x = reach * number() + 0.03f, y = reach * number() + 0.03f;
        for (int corner = 0; corner < 3; ++corner) {
            const float dx = 0.06f * (number() - 0.5f), dy = 0.06f * (number() - 0.5f);
            scene.positions.push_back({x + dx, y + dy, 0});
        }
        scene.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return scene;
}
// [/scene]

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

// Throws Error naming the first node that differs.
void check_binary(Context& context, const Mesh& mesh, const Sorted& sorted, std::span<const Node> nodes, int root);
// Returns how many records, nodes and triangles, were compared.
std::size_t check_wide(Context& context, const Mesh& mesh, const Sorted& sorted, std::span<const Node> nodes);
