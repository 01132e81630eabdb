#include "validation/cpu_reference/reference.h"

#include <numeric>

#include "engine/core/parallel.h"

namespace twinray::reference {
namespace {

// A triangle cut by boxes: each of their six planes adds a vertex at most.
struct Polygon {
    std::array<dvec3, 9> vertices;
    uint count = 0;

    void add(const dvec3& vertex) {
        if (count < vertices.size()) vertices[count++] = vertex;
    }
};

// Returns the part at or above a plane across an axis, or, with `side` -1, at or below it.
Polygon cut_by_plane(const Polygon& whole, int axis, double plane, double side) {
    Polygon part;
    for (uint i = 0; i < whole.count; ++i) {
        const dvec3 &from = whole.vertices[i], &to = whole.vertices[(i + 1) % whole.count];
        const double above_from = (from[axis] - plane) * side, above_to = (to[axis] - plane) * side;
        if (above_from >= 0) part.add(from);
        if ((above_from < 0) != (above_to < 0)) part.add(from + (to - from) * (above_from / (above_from - above_to)));
    }
    return part;
}

double area_of(const Polygon& polygon) {
    dvec3 twice(0);
    for (uint i = 2; i < polygon.count; ++i)
        twice += cross(polygon.vertices[i - 1] - polygon.vertices[0], polygon.vertices[i] - polygon.vertices[0]);
    return length(twice) / 2;
}

double area_within(const BvhTriangle& triangle, const LeafBox& box) {
    Polygon polygon{{dvec3(triangle.v0), dvec3(triangle.v1), dvec3(triangle.v2)}, 3};
    for (int axis = 0; axis < 3; ++axis) {
        polygon = cut_by_plane(polygon, axis, double{box.lo[axis]}, 1);
        polygon = cut_by_plane(polygon, axis, double{box.hi[axis]}, -1);
    }
    return area_of(polygon);
}

bool is_apart(const LeafBox& a, const LeafBox& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.lo[axis] > b.hi[axis] || b.lo[axis] > a.hi[axis]) return true;
    return false;
}

struct LeafTriangle {
    BvhTriangle triangle;
    uint reference;  // as nodes name it
};

std::vector<LeafTriangle> leaves_of(const BuiltTree& tree) {
    std::vector<LeafTriangle> leaves;
    for (uint i = 0; i < tree.triangles.size(); ++i) leaves.push_back({tree.triangles[i], LEAF_BIT | i});
    const Floats vertices = tree.vertices.empty() ? Floats{} : Floats::to(&tree.vertices.front().x);
    for (uint i = 0; i < tree.records.size(); ++i) {
        const CompressedRecord& record = tree.records[i];
        if (!is_leaf(record)) continue;
        const LeafVertices of_leaf = vertices_of_leaf(record, vertices);
        leaves.push_back({primitive_in(of_leaf, false), i});
        if (is_pair(record)) leaves.push_back({primitive_in(of_leaf, true), i});
    }
    return leaves;
}

// Returns the area of a triangle within boxes that are not above its leaf. Boxes above it hold all of the triangle:
// they are counted with the others, and subtracted once their number is known.
double overlap_of(const SwGeometry& geometry, const LeafTriangle& leaf) {
    const LeafBox around = box_of_triangle(leaf.triangle);
    if (!is_active(around) || geometry.bvh.root == leaf.reference) return 0;
    double overlap = 0;
    uint above = 0;
    std::vector<std::pair<uint, uint>> waiting = {{geometry.bvh.root, 0}};  // nodes and their depths
    while (!waiting.empty()) {
        const auto [index, depth] = waiting.back();
        waiting.pop_back();
        const AnyNode node = node_of(geometry, index);
        for (uint slot = 0; slot < slots_of(geometry); ++slot) {
            if (!has_child(node.slots, slot)) continue;
            const LeafBox box = box_in(geometry, node, slot);
            if (is_apart(around, box)) continue;
            overlap += area_within(leaf.triangle, box);
            const uint child = child_in(geometry, node, slot);
            if (child == leaf.reference) above = depth + 1;
            if (is_inner_child(geometry, child)) waiting.emplace_back(child, depth + 1);
        }
    }
    return std::max(overlap - above * area_within(leaf.triangle, around), 0.0);
}

}  // namespace

double end_point_overlap(const BuiltTree& tree) {
    SwGeometry geometry{};
    geometry.bvh = tree.bvh;
    geometry.bvh.nodes = Ref<BvhNode>::to(tree.nodes.data());
    geometry.triangles = Ref<BvhTriangle>::to(tree.triangles.data());
    geometry.records = Ref<CompressedRecord>::to(tree.records.data());
    const std::vector<LeafTriangle> leaves = leaves_of(tree);
    std::vector<double> overlaps(leaves.size());
    parallel_for(leaves.size(), [&](std::size_t i) { overlaps[i] = overlap_of(geometry, leaves[i]); });
    double area = 0;
    for (const LeafTriangle& leaf : leaves)
        if (const LeafBox box = box_of_triangle(leaf.triangle); is_active(box)) area += area_within(leaf.triangle, box);
    return area > 0 ? std::accumulate(overlaps.begin(), overlaps.end(), 0.0) / area : 0;
}

}  // namespace twinray::reference
