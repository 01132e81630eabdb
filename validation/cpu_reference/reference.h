// CPU references of the build kernels, one function per stage by the same name. They share the kernels' arithmetic
// (shaders/shared) but not their algorithms, so that a test can compare every stage bit for bit.
#pragma once

#include <span>
#include <vector>

#include "engine/accel/trace_desc.h"
#include "engine/scene/mesh.h"
#include "swtlas/structures.h"
#include "swtlas/tree.h"

namespace twinray::reference {

// `leaves`, here and below: as Geometry::leaves.
std::vector<LeafBox> leaves_triangles(std::span<const vec3> positions, std::span<const uvec3> triangles,
                                      std::span<const Leaf> leaves = {});

// Writes the instances and returns their world boxes. geometry addresses are host addresses of SwGeometry.
std::vector<LeafBox> leaves_instances(std::span<const InstanceRecord> records, std::vector<SwInstance>& instances);

CentroidBounds centroids(std::span<const LeafBox> boxes);
// The halves of each leaf's 60-bit code. Low ones exist only if a tree is also sorted by them.
struct Codes {
    std::vector<uint> high, low;
};
Codes morton(std::span<const LeafBox> boxes, const CentroidBounds& bounds);

// Returns leaf indices sorted by code; equal codes stay in order.
std::vector<uint> sort(const Codes& codes);

struct Hierarchy {
    std::vector<BvhNode> nodes;
    uint root = NOTHING;
    LeafBox box = empty_box();
};
// Builds top-down: a range is cut at its highest split. With quality ploc it has the clusters of both parts to join.
Hierarchy hierarchy(std::span<const LeafBox> boxes, const Codes& codes, std::span<const uint> order,
                    bool leaves_are_sorted, BuildQuality quality = BuildQuality::fast);

// Returns a tree of layout bvh2, whose nodes know their edges.
Hierarchy linked(Hierarchy tree);

std::vector<BvhTriangle> encode_triangles(std::span<const vec3> positions, std::span<const uvec3> triangles,
                                          std::span<const uint> order);

// Returns the records, with nodes of up to `width` children, of a tree whose references are the leaves' own indices.
// (The kernels' binary trees refer to positions in the order; their records are the same.)
std::vector<CompressedRecord> records_of_triangles(const Hierarchy& tree, std::span<const vec3> positions,
                                                   std::span<const uvec3> triangles, uint width,
                                                   std::span<const Leaf> leaves = {});
std::vector<CompressedRecord> records_of_instances(const Hierarchy& tree, uint leaf_count, uint width);

// A measure that distinguishes trees of equal surface-area cost: how many boxes a ray enters in vain near where it ends
// (Aila, Karras, Laine, "On Quality Metrics of Bounding Volume Hierarchies", 2013; all costs are 1).
// Returns, over all boxes but the root's, the area of the triangles within that do not lie below the box, over the area
// of all; 0 if no box holds a part of such a triangle. `tree` is that of a geometry of triangles, in any layout.
double end_point_overlap(const BuiltTree& tree);

}  // namespace twinray::reference
