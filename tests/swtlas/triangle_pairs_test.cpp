// SPDX-License-Identifier: MIT
// Which triangles share a leaf, and what its record says of them.
#include "swtlas/triangle_pairs.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

#include <twinray/geometry.h>

namespace twinray {
namespace {

bool shares_edge(uvec3 a, uvec3 b) {
    int shared = 0;
    for (int i = 0; i < 3; ++i) shared += a[i] == b.x || a[i] == b.y || a[i] == b.z ? 1 : 0;
    return shared >= 2;
}

// Each triangle is in one leaf, and two of a leaf share an edge.
void expect_partition(const Mesh& mesh, const std::vector<uint>& leaves) {
    std::set<uint> seen;
    for (const uint leaf : leaves) {
        EXPECT_TRUE(seen.insert(first_in_leaf(leaf)).second);
        if (count_in_leaf(leaf) == 1) continue;
        EXPECT_TRUE(seen.insert(second_in_leaf(leaf)).second);
        EXPECT_TRUE(shares_edge(mesh.triangles[first_in_leaf(leaf)], mesh.triangles[second_in_leaf(leaf)]));
    }
    EXPECT_EQ(seen.size(), mesh.triangles.size());
    EXPECT_LT(*seen.rbegin(), mesh.triangles.size());
}

TEST(TrianglePairs, MostTrianglesOfASurfaceShareALeaf) {
    for (const uint level : {1u, 3u, 5u}) {
        const Mesh mesh = make_icosphere(level);
        const std::vector<uint> leaves = pair_triangles(mesh.positions, mesh.triangles);
        expect_partition(mesh, leaves);
        EXPECT_LT(static_cast<double>(leaves.size()), 0.6 * static_cast<double>(mesh.triangles.size()));
    }
}

TEST(TrianglePairs, ThreadsDoNotMatter) {
    const Mesh mesh = make_icosphere(7);  // enough for several
    const std::vector<uint> leaves = pair_triangles(mesh.positions, mesh.triangles);
    expect_partition(mesh, leaves);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(pair_triangles(mesh.positions, mesh.triangles), leaves);
}

TEST(TrianglePairs, TrianglesWithoutCommonEdgesHaveLeavesOfTheirOwn) {
    EXPECT_TRUE(pair_triangles({}, {}).empty());
    for (const Mesh& mesh : {make_soup(1, 1), make_soup(300, 2)})
        EXPECT_TRUE(pair_triangles(mesh.positions, mesh.triangles).empty());
}

// Many vertices that few triangles use would take more than the leaves save.
TEST(TrianglePairs, UnusedVerticesArePaidForByLeaves) {
    Mesh mesh = make_icosphere(3);
    ASSERT_FALSE(pair_triangles(mesh.positions, mesh.triangles).empty());
    mesh.positions.resize(4 * mesh.triangles.size());
    EXPECT_TRUE(pair_triangles(mesh.positions, mesh.triangles).empty());
}

// Pairs of squares at a right angle, of two triangles each: a box around both squares' nearest triangles is larger than
// their own.
TEST(TrianglePairs, ACommonBoxIsNoLargerThanBoth) {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles, corners;
    std::vector<uint> expected;
    for (uint i = 0; i < 20; ++i) {
        const uvec3 first(static_cast<uint>(positions.size()));
        for (const vec3& p : {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(1, 1, 0), vec3(1, 0, 1), vec3(1, 1, 1)})
            positions.push_back(p + vec3(0, static_cast<float>(3 * i), 0));
        for (const uvec3& t : {uvec3(0, 1, 2), uvec3(1, 3, 2), uvec3(1, 4, 3), uvec3(4, 5, 3)})
            triangles.push_back(first + t);
        for (const uvec3& t : {uvec3(1, 3, 2), uvec3(1, 4, 3)}) corners.push_back(first + t);
        expected.insert(expected.end(), {make_leaf(4 * i, 1), make_leaf(4 * i + 2, 1)});
    }
    EXPECT_EQ(pair_triangles(positions, triangles), expected);
    EXPECT_TRUE(pair_triangles(positions, corners).empty());
}

TEST(TrianglePairs, PositionsThatAreNoNumbersAndCollapsedEdgesAreNoFault) {
    Mesh mesh = make_icosphere(4);
    mesh.positions[7].y = NAN;
    mesh.positions[30].x = INFINITY;
    mesh.triangles[11] = uvec3(3);
    mesh.triangles[12] = uvec3(3, 3, 9);
    mesh.triangles[14] = mesh.triangles[13];  // twice the same
    mesh.triangles[15] = mesh.triangles[13];
    expect_partition(mesh, pair_triangles(mesh.positions, mesh.triangles));
}

// Two triangles have their vertices in every order, and each of them is inactive once.
TEST(TrianglePairs, RecordsGiveBackTheTrianglesAsTheyWere) {
    const std::vector<vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5f}};
    std::array<uint, 3> first = {0, 1, 2};
    do {
        std::array<uint, 3> second = {1, 2, 3};
        do
            for (uint which = 0; which < 4; ++which) {
                const std::vector<uvec3> triangles = {{first[0], first[1], first[2]},
                                                      {second[0], second[1], second[2]}};
                BuildTree tree{};
                tree.indices = Uints::to(&triangles.data()->x);
                const CompressedRecord record = encode_pair(tree, make_leaf(0, 1), which);
                const Floats vertices = Floats::to(&positions.data()->x);
                for (uint i = 0; i < 2; ++i) {
                    const LeafVertices of_leaf = vertices_of_leaf(record, vertices);
                    const BvhTriangle t = primitive_in(of_leaf, i == 1);
                    EXPECT_EQ(t.primitive_index, i);
                    EXPECT_EQ(of_leaf.there, which);
                    EXPECT_EQ(t.v0, positions[triangles[i].x]);
                    EXPECT_EQ(t.v1, positions[triangles[i].y]);
                    EXPECT_EQ(t.v2, positions[triangles[i].z]);
                }
                EXPECT_EQ(leaf_of(record), make_leaf(0, 1));
            }
        while (std::ranges::next_permutation(second).found);
    } while (std::ranges::next_permutation(first).found);
}

}  // namespace
}  // namespace twinray
