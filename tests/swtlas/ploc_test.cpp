// SPDX-License-Identifier: MIT
// Builds of quality ploc where nearest neighbours are of little use, or would make trees too high.
#include <cmath>
#include <random>

#include "tests/support/sw_build.h"

namespace twinray {
namespace {

using namespace test;

class SwPloc : public SwBuildTest {
  protected:
    // Inner nodes on the longest way down the tree of a mesh alone, which is sound and equal to its CPU reference.
    uint checked_depth(const Mesh& mesh) {
        SwTlas accel(context(), options());
        const AccelHandle handle = accel.push(mesh);
        accel.sync();
        const BuiltTree tree = download_geometry(accel, handle);
        expect_sound(tree, mesh);
        expect_reference(tree, mesh, quality());
        const std::vector<LeafBox> boxes = leaf_boxes(tree, mesh);
        return has_records(tree) ? check_tree(tree.bvh, tree.records, boxes).depth
                                 : check_tree(tree.bvh, tree.nodes, boxes).depth;
    }
    bool is_binary() const { return std::get<Layout>(GetParam()) == Layout::bvh2; }
};
INSTANTIATE_TEST_SUITE_P(Every, SwPloc,
                         testing::Values(How{Layout::compressed4, BuildQuality::ploc, KernelShape::of_device},
                                         How{Layout::compressed8, BuildQuality::ploc, KernelShape::of_device},
                                         How{Layout::bvh2, BuildQuality::ploc, KernelShape::of_device},
                                         How{Layout::bvh2, BuildQuality::ploc, KernelShape::of_gpu}),
                         name_of_build);

// With a box of 2 * size around `center`.
void add_triangle(Mesh& mesh, vec3 center, float size) {
    const auto first = static_cast<uint>(mesh.positions.size());
    for (const vec3& corner : {vec3(1, -1, 1), vec3(-1, 1, 1), vec3(1, 1, -1)})
        mesh.positions.push_back(center + size * corner);
    mesh.triangles.push_back({first, first + 1, first + 2});
}

// Each box is within the next one, so that the nearest neighbour is always the smallest: a chain. One lies apart, for
// areas are measured in the extent of the centres.
Mesh nested(uint count, float growth) {
    Mesh mesh;
    mesh.name = text("nested ", count);
    for (uint i = 0; i < count; ++i)
        add_triangle(mesh, vec3(0), std::pow(growth, static_cast<float>(i) - static_cast<float>(count) / 2));
    add_triangle(mesh, vec3(1), 1);
    return mesh;
}

TEST_P(SwPloc, ATreeOfNestedBoxesIsAsHighAsItMayBeAndNoHigher) {
    for (const uint count : {17u, 32u, 33u, 100u, 300u, 3000u}) {
        const uint depth = checked_depth(nested(count, count == 3000 ? 1.01f : 1.2f));
        if (!is_binary()) continue;
        // Centres are split by 25 bits of places, then what was kept of them from the one that lies apart.
        EXPECT_LE(depth, 25 + KEPT_CLUSTERS) << count;
        EXPECT_GE(depth, std::min(count - 1, 20u)) << count << ": the limit is not met";
    }
}

// On ever lower bits of the codes, then of their lower halves, then of positions.
TEST_P(SwPloc, NestedBoxesAtTheEndOfALongWayDownStayWithinTheDeepestTree) {
    for (const uint places : {20u, 200u}) {
        Mesh mesh = nested(places, 1.05f);
        for (vec3& position : mesh.positions) position *= std::ldexp(1.0f, -40);
        for (uint i = 0; i < 57; ++i) {
            vec3 center(0);
            center[static_cast<int>(2 - i % 3)] = std::ldexp(1.0f, -static_cast<int>(i / 3));
            add_triangle(mesh, center, std::ldexp(1.0f, -25));
            add_triangle(mesh, center, std::ldexp(2.0f, -static_cast<int>(i / 3)));
        }
        EXPECT_GT(checked_depth(mesh), 0u);
    }
}

TEST_P(SwPloc, RandomNestedBoxesAreSoundAndEqualToTheirReferences) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1);
    for (uint round = 0; round < 12; ++round) {
        Mesh mesh;
        mesh.name = text("round ", round);
        const auto places = static_cast<uint>(1 + random() % 5), count = static_cast<uint>(20 + random() % 400);
        for (uint i = 0; i < count; ++i)
            add_triangle(mesh, vec3(static_cast<float>(random() % places), 0, 0), std::exp2(-30 * unit(random)));
        EXPECT_GT(checked_depth(mesh), 0u);
    }
}

TEST_P(SwPloc, EqualBoxesMakeABalancedTree) {
    Mesh mesh;
    mesh.name = "equal";
    for (uint i = 0; i < 4096; ++i) add_triangle(mesh, vec3(1), 1);
    EXPECT_LE(checked_depth(mesh), 12u);
}

// Of no area, so that all pairs are the same.
TEST_P(SwPloc, LeavesInALineAreSoundAndEqualToTheirReferences) {
    Mesh even, growing;
    even.name = "even";
    growing.name = "growing";
    for (uint i = 0; i < 2000; ++i) {
        const auto x = static_cast<float>(i);
        for (const float end : {x, x + 1, x}) even.positions.emplace_back(end, 0, 0);
        for (const float end : {x, x + 1, x}) growing.positions.emplace_back(std::pow(1.02f, end), 0, 0);
        even.triangles.push_back(uvec3(3 * i) + uvec3(0, 1, 2));
    }
    growing.triangles = even.triangles;
    EXPECT_GT(checked_depth(even), 0u);
    EXPECT_GT(checked_depth(growing), 0u);
}

TEST_P(SwPloc, AreasBeyondTheRangeOfFloatsAreSoundAndEqualToTheirReferences) {
    Mesh mesh = make_soup(500, 1);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.positions[i] *= std::ldexp(1.0f, 120 - static_cast<int>(i / 3 % 60) * 4);
    EXPECT_GT(checked_depth(mesh), 0u);
    for (vec3& position : mesh.positions) position *= std::ldexp(1.0f, -100);  // a huge one among tiny ones
    add_triangle(mesh, vec3(0), std::ldexp(1.0f, 126));
    EXPECT_GT(checked_depth(mesh), 0u);
}

}  // namespace
}  // namespace twinray
