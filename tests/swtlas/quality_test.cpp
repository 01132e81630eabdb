// SPDX-License-Identifier: MIT
// Costs of trees by quality of the build, and end_point_overlap() against its definition.
#include <cmath>
#include <random>
#include <set>

#include "swtlas/tree.h"
#include "tests/support/sw_build.h"
#include "validation/cpu_reference/end_point_overlap.h"

namespace twinray {
namespace {

// Makes triangles of many sizes and shapes, as architecture has: long walls, panels, small parts.
Mesh mixed_triangles(std::size_t count) {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> unit(-1, 1);
    Mesh mesh;
    for (uint i = 0; i < count; ++i) {
        const float size = std::ldexp(1.0f, -static_cast<int>(random() % 10));
        const vec3 place(unit(random), unit(random), unit(random));
        for (uint corner = 0; corner < 3; ++corner) {
            vec3 offset(unit(random), unit(random), unit(random));
            offset[static_cast<int>(i % 3)] = 0;
            mesh.positions.push_back(place + size * offset);
        }
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

class SwQuality : public test::VulkanTest, public testing::WithParamInterface<Layout> {};
INSTANTIATE_TEST_SUITE_P(Every, SwQuality, testing::ValuesIn(all_layouts),
                         [](const auto& layout) { return std::string(name_of(layout.param)); });

TEST_P(SwQuality, HighAndPlocCostRaysLess) {
    for (const Mesh& mesh : {mixed_triangles(20'000), make_icosphere(6)}) {
        double sah[all_build_qualities.size()];
        for (const BuildQuality quality : all_build_qualities) {
            SwTlas accel(context(), {.layout = GetParam(), .build_quality = quality});
            const AccelHandle handle = accel.push(mesh);
            accel.sync();
            const BuiltTree tree = download_geometry(accel, handle);
            sah[static_cast<std::size_t>(quality)] = test::sah_of(tree, test::leaf_boxes(tree, mesh));
        }
        std::printf("surface-area cost of %zu triangles: fast %.2f, high %.2f, ploc %.2f\n", mesh.triangles.size(),
                    sah[0], sah[1], sah[2]);
        // On a sphere, whose triangles are alike, nodes of eight leave little to gain.
        const bool is_wide = GetParam() == Layout::compressed8;
        EXPECT_LT(sah[1], (is_wide ? 0.99 : 0.97) * sah[0]);
        EXPECT_LT(sah[2], (is_wide ? 0.995 : 0.99) * sah[0]);
    }
}

using Corners = std::vector<dvec3>;

Corners cut(const Corners& whole, int axis, double plane, double side) {
    Corners part;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const dvec3 &from = whole[i], &to = whole[(i + 1) % whole.size()];
        const double a = (from[axis] - plane) * side, b = (to[axis] - plane) * side;
        if (a >= 0) part.push_back(from);
        if ((a < 0) != (b < 0)) part.push_back(from + (to - from) * (a / (a - b)));
    }
    return part;
}

double area_of(const Corners& corners) {
    dvec3 twice(0);
    for (std::size_t i = 2; i < corners.size(); ++i)
        twice += cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    return length(twice) / 2;
}

double area_in(Corners corners, const LeafBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
        corners = cut(corners, axis, double{box.lo[axis]}, 1);
        corners = cut(corners, axis, double{box.hi[axis]}, -1);
    }
    return area_of(corners);
}

// A box below the root's, with the primitives below it.
struct Box {
    LeafBox box;
    std::set<uint> below;
};

std::set<uint> collect(const BuiltTree& tree, uint reference, std::vector<Box>& boxes) {
    std::vector<std::pair<LeafBox, uint>> children;
    if (tree.records.empty()) {
        if (reference & LEAF_BIT) return {tree.triangles[reference & ~LEAF_BIT].primitive_index};
        const BvhNode& node = tree.nodes[reference];
        children = {{{node.lo0, node.hi0}, node.child0}, {{node.lo1, node.hi1}, node.child1}};
    } else {
        const CompressedRecord& record = tree.records[reference];
        if (is_leaf(record) && is_pair(record)) return {index_in(record), second_index_in(record)};
        if (is_leaf(record)) return {index_in(record)};
        const CompressedRecord& second_half = tree.records[is_wide_node(record) ? reference + 1 : reference];
        const ChildSlots slots = child_slots(record, second_half);
        for (uint slot = 0; slot < 8; ++slot) {
            if (!has_child(slots, slot)) continue;
            const uint child = child_index(slots, slot);
            children.emplace_back(box_in_planes(record, second_half, slot), child);
        }
    }
    std::set<uint> all;
    for (const auto& [box, child] : children) {
        std::set<uint> below = collect(tree, child, boxes);
        all.insert(below.begin(), below.end());
        boxes.push_back({box, std::move(below)});
    }
    return all;
}

double overlap_of(const BuiltTree& tree, const Mesh& mesh) {
    std::vector<Box> boxes;
    collect(tree, tree.bvh.root, boxes);
    double overlap = 0, area = 0;
    for (uint i = 0; i < mesh.triangles.size(); ++i) {
        const uvec3 t = mesh.triangles[i];
        const Corners corners = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
        area += area_of(corners);
        for (const Box& box : boxes)
            if (!box.below.contains(i)) overlap += area_in(corners, box.box);
    }
    return overlap / area;
}

class SwOverlap : public test::VulkanTest, public testing::WithParamInterface<Layout> {};
INSTANTIATE_TEST_SUITE_P(Every, SwOverlap, testing::ValuesIn(all_layouts),
                         [](const auto& layout) { return std::string(name_of(layout.param)); });

TEST_P(SwOverlap, IsThatOfItsDefinition) {
    SwTlas accel(context(), {.layout = GetParam()});
    Mesh far = make_soup(200, 2, 0.3f);
    for (vec3& position : far.positions) position = (position + 3.0f) * 0x1p55f;
    for (const Mesh& mesh : {make_soup(300, 1, 0.5f), make_icosphere(2), far}) {
        const AccelHandle handle = accel.push(mesh);
        accel.sync();
        const BuiltTree tree = download_geometry(accel, handle);
        const double expected = overlap_of(tree, mesh);
        // Boxes of compressed nodes may stick out of their parents' by a rounding: whoever goes down the tree, as rays
        // do, misses what lies there. Without that the two agree to 1e-9.
        EXPECT_NEAR(reference::end_point_overlap(tree), expected, 1e-6 * expected);
        EXPECT_GT(expected, 0.01) << "the test would see nothing";
    }
}

TEST_P(SwOverlap, IsNothingWhereBoxesHoldTheirOwnAlone) {
    SwTlas accel(context(), {.layout = GetParam()});
    Mesh apart;
    for (uint i = 0; i < 9; ++i) {
        const vec3 at(static_cast<float>(10 * i), 0, 0);
        for (const vec3& corner : {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0.5f)}) apart.positions.push_back(at + corner);
        apart.triangles.push_back(uvec3(3 * i) + uvec3(0, 1, 2));
    }
    Mesh one = apart;
    one.triangles.resize(1);
    for (const Mesh& mesh : {apart, one, Mesh{}}) {
        const AccelHandle handle = accel.push(mesh);
        accel.sync();
        EXPECT_NEAR(reference::end_point_overlap(download_geometry(accel, handle)), 0, 1e-9);
    }
}

}  // namespace
}  // namespace twinray
