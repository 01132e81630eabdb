// SPDX-License-Identifier: MIT
// The steps of a tree's build, with a picture for each, and the engine's tree beside it: inside_the_builder FOLDER
#include <iostream>

#include "drawing.h"
#include "engine_tree.h"
#include "scene.h"

int main(int argc, char** argv) try {
    if (argc != 2) throw Error("usage: inside_the_builder FOLDER");
    const std::filesystem::path folder = argv[1];
    std::filesystem::create_directories(folder);
    // [steps]
    const Mesh scene = make_scene(32, 5);
    const std::vector<Bounds> boxes = boxes_of(scene);
    const Sorted sorted = morton_order(boxes);
    std::vector<Node> binary;
    const int root = radix_tree(sorted, boxes, binary);
    const std::vector<Node> wide = collapse(binary, root, 4);
    std::cout << scene.triangles.size() << " triangles, " << binary.size() << " binary nodes, " << wide.size()
              << " nodes of up to four children\n";
    // [/steps]
    Drawing morton, radix, four;
    morton.triangles(scene);
    morton.cells(3);
    morton.curve(sorted, boxes);
    morton.write(folder / "10_morton.svg");
    radix.triangles(scene);
    radix.tree(binary, root, boxes.size());
    radix.write(folder / "10_radix_tree.svg");
    four.triangles(scene);
    four.tree(wide, 0, boxes.size());
    four.write(folder / "10_wide_tree.svg");
    // [check]
    Context context;
    check_binary(context, scene, sorted, binary, root);
    const std::size_t compared = check_wide(context, scene, sorted, wide);
    std::cout << "the engine's binary tree is the same, bit for bit; so are " << compared
              << " records of its tree of four\n";
    // [/check]
} catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
