// Copies of the structures of SwTlas, and checks on the host of the properties that traversal and refits rely on.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <twinray/tlas.h>

#include "swtlas/structures.h"

namespace twinray {

struct BuiltTree {
    Bvh bvh;
    std::vector<BvhNode> nodes;             // of layout bvh2
    std::vector<BvhTriangle> triangles;     // of a geometry in layout bvh2
    std::vector<CompressedRecord> records;  // of all other layouts
    SharedArray<vec3> vertices;             // of leaves of two triangles
};
// Downloads it. Throws Error on a dead or unsynced handle.
BuiltTree download_geometry(const SwTlas& accel, AccelHandle handle);
BuiltTree download_scene(const SwTlas& accel);

struct TreeCheck {
    std::vector<std::string> violations;  // one sentence each, at most 20
    uint depth = 0;                       // inner nodes on the longest path
    uint width = 0;                       // how many children a node may have; 0: there is no node
    double sah = 0;                       // the surface-area cost, see surface_area.h, of the boxes as rays meet them
};

// Checks a tree of layout bvh2: every leaf and every inner node is reached exactly once, every child's box is the union
// of the boxes below it (so it contains those, exactly), nodes know their edges, and the depth is within the limit of a
// traversal's stack. leaf_boxes[i] is the box of the leaf that reference LEAF_BIT | i names.
TreeCheck check_tree(const Bvh& bvh, std::span<const BvhNode> nodes, std::span<const LeafBox> leaf_boxes);

// Checks a tree of any other layout, from records[0]: `bvh` has the box of all leaves, every leaf is reached exactly
// once, no record twice, unreached records are none, nodes have two children at least and are all of the width of the
// root, the planes of a child are outside of everything below it by more than traversal's rounding, and the depth is
// within the limit of its stack. leaf_boxes[i] is the box of primitive or instance i; an empty one may be anywhere.
TreeCheck check_tree(const Bvh& bvh, std::span<const CompressedRecord> records, std::span<const LeafBox> leaf_boxes);

}  // namespace twinray
