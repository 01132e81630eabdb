// Trees that SwTlas builds: they are sound, equal to those of the CPU reference, and within the height limit.
#include "swtlas/plan.h"
#include "tests/support/sw_build.h"

namespace twinray {
namespace {

using namespace test;

class SwBuild : public SwBuildTest {
  protected:
    // The tree of a mesh alone, which is sound and equal to its CPU reference.
    BuiltTree checked_tree(const Mesh& mesh) {
        SwTlas accel(context(), options());
        const AccelHandle handle = accel.push(mesh);
        accel.sync();
        BuiltTree tree = download_geometry(accel, handle);
        expect_sound(tree, mesh);
        expect_reference(tree, mesh, quality());
        return tree;
    }
    // Returns how many inner nodes are on the longest way down.
    uint checked_depth(const Mesh& mesh) {
        const BuiltTree tree = checked_tree(mesh);
        const std::vector<LeafBox> boxes = leaf_boxes(tree, mesh);
        return has_records(tree) ? check_tree(tree.bvh, tree.records, boxes).depth
                                 : check_tree(tree.bvh, tree.nodes, boxes).depth;
    }
    // Expects the reference's trees from meshes that are built together.
    void expect_references(std::span<const Mesh> meshes) {
        SwTlas accel(context(), options());
        std::vector<AccelHandle> handles;
        for (const Mesh& mesh : meshes) handles.push_back(accel.push(mesh));
        accel.sync();
        for (std::size_t i = 0; i < meshes.size(); ++i)
            expect_reference(download_geometry(accel, handles[i]), meshes[i], quality());
    }
    bool is_binary() const { return std::get<Layout>(GetParam()) == Layout::bvh2; }
};
INSTANTIATE_TEST_SUITE_P(Every, SwBuild, builds_of_the_default_layout(), name_of_build);
INSTANTIATE_TEST_SUITE_P(Full, SwBuild, builds_of_other_layouts(), name_of_build);

// Returns n copies of one triangle: all centroids are equal.
Mesh equal_triangles(std::size_t n) {
    Mesh mesh;
    mesh.name = "equal";
    mesh.positions = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)};
    mesh.triangles.assign(n, uvec3(0, 1, 2));
    return mesh;
}

TEST_P(SwBuild, EveryMeshOfABatchOfAllSmallSizesIsSoundAndEqualToItsReference) {
    SwTlas accel(context(), options());
    std::vector<Mesh> meshes;
    std::vector<AccelHandle> handles;
    for (uint i = 0; i < 1100; ++i) {  // more trees than a pass of the sort has digits
        meshes.push_back(make_soup(i <= 300 ? i : i % 5, i));
        handles.push_back(accel.push(meshes.back()));
    }
    accel.sync();
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const BuiltTree tree = download_geometry(accel, handles[i]);
        expect_sound(tree, meshes[i]);
        expect_reference(tree, meshes[i], quality());
    }
}

// Makes each triangle of a soup, with one behind it that is a little lower: their codes are equal, and the lower halves
// of 60-bit codes are in the other order. Only a few are, so they do not count.
Mesh pairs_of_equal_codes(uint seed) {
    Mesh mesh = make_soup(100, seed);
    const auto corners = static_cast<uint>(mesh.positions.size());
    for (uint i = 0; i < corners; ++i) mesh.positions.push_back(mesh.positions[i] - vec3(1e-5f));
    for (std::size_t i = 0; i < 100; ++i) mesh.triangles.push_back(mesh.triangles[i] + corners);
    return mesh;
}

std::size_t count_equal_codes(const Mesh& mesh) {
    const std::vector<LeafBox> boxes = reference::leaves_triangles(built(mesh), mesh.triangles);
    const std::vector<uint> codes = reference::morton(boxes, reference::centroids(boxes)).high;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 100; ++i) count += codes[i] == codes[i + 100] ? 1 : 0;
    return count;
}

TEST_P(SwBuild, EqualCodesThatAreNoCrowdKeepTheirOrder) {
    EXPECT_GT(count_equal_codes(pairs_of_equal_codes(1)), 80u);
    expect_references(std::array{pairs_of_equal_codes(1), pairs_of_equal_codes(2), pairs_of_equal_codes(3)});
}

TEST_P(SwBuild, ATreeDoesNotDependOnTheOthersOfItsBatch) {
    expect_references(std::array{make_soup(5, 1), equal_triangles(1000), make_soup(3, 2), equal_triangles(77)});
}

TEST_P(SwBuild, ATreeDoesNotDependOnTheScratchBudget) {
    std::vector<Mesh> meshes;
    for (const uint n : {700u, 0u, 1u, 2048u, 3000u, 5u, 257u}) meshes.push_back(make_soup(n, n));
    for (const std::uint64_t budget : {std::uint64_t{0}, std::uint64_t{200'000}, UINT64_MAX}) {
        SwTlas accel(context(), options());
        accel.set_scratch_budget(budget);
        std::vector<AccelHandle> handles;
        for (const Mesh& mesh : meshes) handles.push_back(accel.push(mesh));
        accel.sync();
        for (std::size_t i = 0; i < meshes.size(); ++i)
            expect_reference(download_geometry(accel, handles[i]), meshes[i], quality());
        for (std::size_t i = 0; i < meshes.size(); ++i) accel.update_vertices(handles[i], meshes[i].positions);
        accel.sync();
        for (std::size_t i = 0; i < meshes.size(); ++i)
            expect_reference(download_geometry(accel, handles[i]), meshes[i], quality());
    }
}

TEST_P(SwBuild, TreesOfABatchWithLevelsAndSubtreesAreEqualToTheirReferences) {
    const uint most = plan_build({}, Layout::compressed4, context().state().tuning()).subtree_leaves;
    std::vector<Mesh> meshes;
    for (const uint n : {most - 1, 3u, 5 * most, most, 2u, most + 1, 7u}) meshes.push_back(make_soup(n, n, 0.05f));
    expect_references(meshes);
}

// Makes a triangle beside each power of two, along the axes in turn, and behind these `count` that lie close together.
Mesh chain_before_a_clump(uint depth, uint count) {
    Mesh mesh = make_soup(count, 9, 0.01f);
    for (vec3& position : mesh.positions) position *= std::ldexp(1.0f, -20);
    for (uint i = 0; i < depth; ++i) {
        vec3 center(0);
        center[static_cast<int>(2 - i % 3)] = std::ldexp(1.0f, -static_cast<int>(i / 3));
        const auto first = static_cast<uint>(mesh.positions.size());
        for (const vec3& corner : {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)})
            mesh.positions.push_back(center + corner * std::ldexp(1.0f, -25));
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

TEST_P(SwBuild, ALargeSubtreeIsLeftBelowTheLastLevel) {
    const uint most = plan_build({}, Layout::compressed4, context().state().tuning()).subtree_leaves;
    const Mesh mesh = chain_before_a_clump(57, most + 300);
    const auto count = static_cast<uint>(mesh.triangles.size());
    const BuiltTree tree = checked_tree(mesh);
    // Other layouts and qualities make it less deep.
    if (!has_records(tree) || width_of(tree) == 8 || quality() != BuildQuality::fast) return;
    const uint levels =
        plan_build(std::span(&count, 1), Layout::compressed4, context().state().tuning()).collapse_levels;
    EXPECT_GT(check_tree(tree.bvh, tree.records, leaf_boxes(tree, mesh)).depth, levels + 10);
}

TEST_P(SwBuild, LargeMeshesAreSound) {
    for (const uint n : {100'000u, 1'000'000u}) {
        SwTlas accel(context(), options());
        const Mesh mesh = make_soup(n, 7, 0.01f);
        const AccelHandle handle = accel.push(mesh);
        accel.sync();
        const BuiltTree tree = download_geometry(accel, handle);
        expect_sound(tree, mesh);
        if (n == 100'000) expect_reference(tree, mesh, quality());
    }
}

TEST_P(SwBuild, EqualCentroidsAreSplitByPosition) { EXPECT_LE(checked_depth(equal_triangles(1000)), 10u); }

TEST_P(SwBuild, NonFiniteTrianglesAreInactiveAndKeepTheirIndex) {
    Mesh mesh = make_soup(500, 11);
    for (const std::size_t i : {0u, 17u, 255u, 256u, 499u}) {
        const float bad[] = {NAN, INFINITY, -INFINITY};
        mesh.positions[3 * i + i % 3][static_cast<int>(i / 7 % 3)] = bad[i % 3];
    }
    const BuiltTree tree = checked_tree(mesh);
    EXPECT_TRUE(std::isfinite(tree.bvh.lo.x) && std::isfinite(tree.bvh.hi.x));
}

TEST_P(SwBuild, AMeshOfNothingButNansIsEmpty) {
    Mesh mesh = make_soup(5, 3);
    for (vec3& position : mesh.positions) position.y = NAN;
    SwTlas accel(context(), options());
    const AccelHandle handle = accel.push(mesh);
    accel.sync();
    EXPECT_GT(download_geometry(accel, handle).bvh.lo.x, download_geometry(accel, handle).bvh.hi.x);
    const Hit hit = accel.closest_hits(std::vector<Ray>{{vec3(0.5f, 0.5f, -1), 0, vec3(0, 0, 1), INFINITY}}).front();
    EXPECT_EQ(hit.hit, 0u);
}

TEST_P(SwBuild, TheSceneTreeIsSoundOverInstancesAndEqualToItsReference) {
    for (const uint n : {777u, 9000u}) {
        SwTlas accel(context(), options());
        const Mesh mesh = make_soup(10, 1);
        const std::vector<Transform> transforms = scattered(n, 3);
        accel.push(mesh, transforms);
        accel.sync();
        const BuiltTree tree = download_scene(accel);
        const std::vector<LeafBox> boxes = instance_boxes(mesh, transforms, options());
        expect_sound(tree, boxes, "instances");
        const reference::Codes codes = reference::morton(boxes, reference::centroids(boxes));
        const reference::Hierarchy expected =
            reference::hierarchy(boxes, codes, reference::sort(codes), false, quality());
        if (has_records(tree))
            EXPECT_TRUE(same_bytes(tree.records, reference::records_of_instances(expected, n, width_of(tree)))) << n;
        else
            EXPECT_TRUE(same_bytes(tree.nodes, reference::linked(expected).nodes)) << n;
    }
}

// Returns the area of all boxes but the root's, which a stray triangle must not change.
double area_below_root(const BuiltTree& tree, const Mesh& mesh) {
    const vec3 size = tree.bvh.hi - tree.bvh.lo;
    const double root =
        double{size.x} * double{size.y} + double{size.y} * double{size.z} + double{size.z} * double{size.x};
    return sah_of(tree, leaf_boxes(tree, mesh)) * root;
}

TEST_P(SwBuild, AStrayTriangleDoesNotSpoilTheOrderOfTheOthers) {
    Mesh mesh = make_icosphere(4);
    mesh.normals.clear();
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(1));
    SwTlas accel(context(), options());
    const AccelHandle alone = accel.push(mesh);
    accel.sync();
    const double area = area_below_root(download_geometry(accel, alone), mesh);
    const auto first = static_cast<uint>(mesh.positions.size());
    for (const vec3& corner : {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)}) mesh.positions.push_back(vec3(3000) + corner);
    mesh.triangles.push_back(uvec3(first, first + 1, first + 2));
    const AccelHandle handle = accel.push(mesh);
    accel.sync();
    const BuiltTree tree = download_geometry(accel, handle);
    expect_sound(tree, mesh);
    expect_reference(tree, mesh, quality());
    // In planes of grids, the topmost boxes of the tree lie far apart.
    EXPECT_LT(area_below_root(tree, mesh), is_binary() ? 1.2 * area : INFINITY);

    // The mesh is built beside others in a batch, of which it is a small part, and which keep their order.
    SwTlas of_many(context(), options());
    const Mesh pairs = pairs_of_equal_codes(1), soup = make_soup(50'000, 1);
    std::vector<AccelHandle> handles;
    for (const Mesh& each : {pairs, mesh, soup}) handles.push_back(of_many.push(each));
    of_many.sync();
    expect_reference(download_geometry(of_many, handles[0]), pairs, quality());
    expect_reference(download_geometry(of_many, handles[2]), soup, quality());
    EXPECT_TRUE(same_bytes(download_geometry(of_many, handles[1]).records, tree.records));
    EXPECT_TRUE(same_bytes(download_geometry(of_many, handles[1]).nodes, tree.nodes));
}

// Builds of quality ploc for which nearest neighbours are of little use, or would make trees too high.
using SwPloc = SwBuild;
INSTANTIATE_TEST_SUITE_P(Every, SwPloc,
                         testing::Values(How{Layout::compressed4, BuildQuality::ploc, KernelShape::of_device},
                                         How{Layout::compressed8, BuildQuality::ploc, KernelShape::of_device},
                                         How{Layout::bvh2, BuildQuality::ploc, KernelShape::of_device},
                                         How{Layout::bvh2, BuildQuality::ploc, KernelShape::of_gpu}),
                         name_of_build);

// Adds a triangle with a box of 2 * size around `center`.
void add_triangle(Mesh& mesh, vec3 center, float size) {
    const auto first = static_cast<uint>(mesh.positions.size());
    for (const vec3& corner : {vec3(1, -1, 1), vec3(-1, 1, 1), vec3(1, 1, -1)})
        mesh.positions.push_back(center + size * corner);
    mesh.triangles.push_back({first, first + 1, first + 2});
}

// Each box is within the next one, so that the nearest neighbour is always the smallest: a chain. One box lies apart,
// since areas are measured in the extent of the centres.
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
        // Centres are split by 25 bits of places; then the kept ones are split from the one that lies apart.
        EXPECT_LE(depth, 25 + KEPT_CLUSTERS) << count;
        EXPECT_GE(depth, std::min(count - 1, 20u)) << count << ": the limit is not met";
    }
}

// Splits use ever lower bits of the codes, then of their lower halves, then of positions.
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

// Triangles have no area, so that all pairs are the same.
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
