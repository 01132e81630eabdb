// Pairs of triangles: which ones share a leaf, and what its record says of them.
#include "swtlas/triangle_pairs.h"

#include "tests/support/sw_build.h"

namespace twinray {
namespace {

bool shares_edge(uvec3 a, uvec3 b) {
    int shared = 0;
    for (int i = 0; i < 3; ++i) shared += a[i] == b.x || a[i] == b.y || a[i] == b.z ? 1 : 0;
    return shared >= 2;
}

std::vector<Leaf> leaves_of(const Mesh& mesh) { return pair_triangles(mesh.positions, mesh.triangles); }

// Returns the first and the second triangle of each leaf.
std::vector<uvec2> numbers(std::span<const Leaf> leaves) {
    std::vector<uvec2> numbers;
    for (const Leaf& leaf : leaves) numbers.emplace_back(leaf.first, leaf.second);
    return numbers;
}

double leaves_a_triangle(const Mesh& mesh) {
    return static_cast<double>(leaves_of(mesh).size()) / static_cast<double>(mesh.triangles.size());
}

// Expects each triangle in one leaf, and two triangles of a leaf to share an edge.
void expect_partition(const Mesh& mesh, const std::vector<Leaf>& leaves) {
    std::set<uint> seen;
    for (const Leaf& leaf : leaves) {
        EXPECT_TRUE(seen.insert(leaf.first).second);
        if (!has_two(leaf)) continue;
        EXPECT_TRUE(seen.insert(leaf.second).second);
        EXPECT_TRUE(shares_edge(mesh.triangles[leaf.first], mesh.triangles[leaf.second]));
    }
    EXPECT_EQ(seen.size(), mesh.triangles.size());
    EXPECT_LT(*seen.rbegin(), mesh.triangles.size());
}

TEST(TrianglePairs, MostTrianglesOfASurfaceShareALeaf) {
    for (const uint level : {1u, 3u, 5u}) {
        const Mesh mesh = make_icosphere(level);
        expect_partition(mesh, leaves_of(mesh));
        EXPECT_LT(leaves_a_triangle(mesh), 0.6);
    }
}

// Scanners leave such meshes: neighbours in space are far from each other in the mesh.
TEST(TrianglePairs, TheOrderOfTrianglesHardlyMatters) {
    Mesh mesh = make_icosphere(5);
    std::ranges::shuffle(mesh.triangles, std::mt19937(1));
    expect_partition(mesh, leaves_of(mesh));
    EXPECT_LT(leaves_a_triangle(mesh), 0.62);
}

TEST(TrianglePairs, ThreadsDoNotMatter) {
    const Mesh mesh = make_icosphere(7);  // enough for several
    const std::vector<Leaf> leaves = leaves_of(mesh);
    expect_partition(mesh, leaves);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(numbers(leaves_of(mesh)), numbers(leaves));
}

TEST(TrianglePairs, TrianglesWithoutCommonEdgesHaveLeavesOfTheirOwn) {
    EXPECT_TRUE(pair_triangles({}, {}).empty());
    for (const Mesh& mesh : {make_soup(1, 1), make_soup(300, 2)}) EXPECT_TRUE(leaves_of(mesh).empty());
}

// Pairs of squares stand at a right angle, with two triangles each: a box around the nearest triangles of both squares
// is larger than their own.
TEST(TrianglePairs, ACommonBoxIsNoLargerThanBoth) {
    std::vector<vec3> positions;
    std::vector<uvec3> triangles, corners;
    std::vector<uvec2> expected;
    for (uint i = 0; i < 20; ++i) {
        const uvec3 first(static_cast<uint>(positions.size()));
        for (const vec3& p : {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(1, 1, 0), vec3(1, 0, 1), vec3(1, 1, 1)})
            positions.push_back(p + vec3(0, static_cast<float>(3 * i), 0));
        for (const uvec3& t : {uvec3(0, 1, 2), uvec3(1, 3, 2), uvec3(1, 4, 3), uvec3(4, 5, 3)})
            triangles.push_back(first + t);
        for (const uvec3& t : {uvec3(1, 3, 2), uvec3(1, 4, 3)}) corners.push_back(first + t);
        expected.insert(expected.end(), {uvec2(4 * i, 4 * i + 1), uvec2(4 * i + 2, 4 * i + 3)});
    }
    EXPECT_EQ(numbers(pair_triangles(positions, triangles)), expected);
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
    expect_partition(mesh, leaves_of(mesh));
}

// If two triangles fold back on each other, only one of their edges has a length.
TEST(TrianglePairs, AnEdgeWhoseEndsLieTogetherIsNotShared) {
    const std::vector<vec3> positions = {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_TRUE(pair_triangles(positions, std::vector<uvec3>{{0, 1, 2}, {1, 0, 3}}).empty());
    EXPECT_EQ(pair_triangles(positions, std::vector<uvec3>{{0, 3, 2}, {2, 3, 0}}).size(), 1u);
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
                EXPECT_EQ(leaf_of(record).first, 0u);
                EXPECT_EQ(leaf_of(record).second, 1u);
            }
        while (std::ranges::next_permutation(second).found);
    } while (std::ranges::next_permutation(first).found);
}

Geometry chosen(const Mesh& mesh, bool has_vertices) {
    Geometry geometry(mesh, 1);
    choose_leaves(geometry, has_vertices);
    return geometry;
}

// Triangles are the same, bit by bit.
TEST(ChosenLeaves, NameOneVertexForEachPlace) {
    const Mesh mesh = test::with_seam(make_icosphere(3));
    const std::size_t places = mesh.positions.size() / 2;
    const Geometry geometry = chosen(mesh, false);
    EXPECT_FALSE(geometry.leaves.empty());
    ASSERT_EQ(geometry.welded.positions.size(), places);
    ASSERT_EQ(geometry.welded.triangles.size(), mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int corner = 0; corner < 3; ++corner)
            EXPECT_EQ(geometry.welded.positions[geometry.welded.triangles[i][corner]],
                      mesh.positions[mesh.triangles[i][corner]]);
    EXPECT_TRUE(chosen(mesh, true).welded.is_empty());
    EXPECT_TRUE(chosen(make_icosphere(3), false).welded.is_empty());
}

TEST(ChosenLeaves, KeepTheSignOfZeroAndPositionsThatAreNoNumbers) {
    Mesh mesh = make_icosphere(2);
    mesh.positions.resize(2 * mesh.positions.size());
    for (const vec3& p : {vec3(-0.0f, 0, 1), vec3(0, 0, 1), vec3(NAN, 0, 1), vec3(NAN, 0, 1)})
        mesh.positions.push_back(p);
    const auto last = static_cast<uint>(mesh.positions.size() - 1);
    mesh.triangles.emplace_back(last - 3, last - 2, 0);
    mesh.triangles.emplace_back(last - 1, last, 0);
    const Welded welded = weld(mesh.positions, mesh.triangles);
    const uvec3 signs = welded.triangles.end()[-2], numbers = welded.triangles.back();
    EXPECT_TRUE(std::signbit(welded.positions[signs.x].x));
    EXPECT_FALSE(std::signbit(welded.positions[signs.y].x));
    EXPECT_EQ(numbers.x, numbers.y);
    EXPECT_TRUE(std::isnan(welded.positions[numbers.x].x));
}

// Few of many triangles share an edge: copies of all vertices would take more memory than their leaves save.
TEST(ChosenLeaves, AreOnesWhereVerticesTakeMore) {
    Mesh mesh = make_soup(300, 3);
    for (std::size_t i = 1; i < 20; i += 2) {
        const uvec3 other = mesh.triangles[i - 1];
        mesh.positions[mesh.triangles[i].z] = mesh.positions[other.z];
        mesh.triangles[i] = uvec3(other.x, other.y, mesh.triangles[i].z);
    }
    ASSERT_EQ(leaves_of(mesh).size(), 290u);
    EXPECT_EQ(chosen(mesh, true).leaves.size(), 0u);  // as many vertices as triangles without a common one
    mesh.positions.pop_back();
    mesh.triangles.back().z = 0;
    EXPECT_EQ(chosen(mesh, false).leaves.size(), 0u);
    EXPECT_EQ(chosen(mesh, true).leaves.size(), 290u);
}

TEST(ChosenLeaves, OfVerticesThatNoTriangleUsesTakeNothing) {
    Mesh mesh = make_icosphere(3);
    const std::size_t used = mesh.positions.size();
    mesh.positions.resize(2 * mesh.triangles.size());
    EXPECT_EQ(chosen(mesh, false).welded.positions.size(), used);
}

// Records belong to the mesh as it was given, then to the welded one, and back.
TEST(NamedVertices, AreThoseOfOtherTriangles) {
    const std::vector<uvec3> given = {{4, 7, 2}, {2, 7, 9}}, welded = {{0, 1, 2}, {2, 1, 3}};
    BuildTree tree{};
    tree.indices = Uints::to(&given.data()->x);
    for (uint which = 0; which < 4; ++which) {
        CompressedRecord records[] = {encode_pair(tree, make_leaf(0, 1), which), no_record()};
        const CompressedRecord before = records[0];
        name_vertices(records, welded);
        EXPECT_EQ(records[0].a.y, 1u);
        EXPECT_EQ(records[0].a.z, 2u);
        EXPECT_EQ(records[0].b.x, 0u);
        EXPECT_EQ(records[0].b.y, 3u);
        name_vertices(records, given);
        EXPECT_EQ(std::memcmp(records, &before, sizeof before), 0);
    }
}

}  // namespace
}  // namespace twinray
