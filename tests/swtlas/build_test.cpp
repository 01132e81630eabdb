// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <random>

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
};
INSTANTIATE_TEST_SUITE_P(Every, SwBuild, builds_of_the_default_layout(), name_of_build);
INSTANTIATE_TEST_SUITE_P(Full, SwBuild, builds_of_other_layouts(), name_of_build);

// n copies of one triangle: all centroids equal.
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

// Each triangle of a soup, and behind it one that is a little lower: their codes are equal, the lower halves of
// 60-bit codes in the other order. Those are few, so they do not count.
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
    SwTlas accel(context(), options());
    const Mesh meshes[] = {pairs_of_equal_codes(1), pairs_of_equal_codes(2), pairs_of_equal_codes(3)};
    std::vector<AccelHandle> handles;
    for (const Mesh& mesh : meshes) handles.push_back(accel.push(mesh));
    accel.sync();
    for (std::size_t i = 0; i < 3; ++i) expect_reference(download_geometry(accel, handles[i]), meshes[i], quality());
}

TEST_P(SwBuild, ATreeDoesNotDependOnTheOthersOfItsBatch) {
    SwTlas accel(context(), options());
    const Mesh meshes[] = {make_soup(5, 1), equal_triangles(1000), make_soup(3, 2), equal_triangles(77)};
    std::vector<AccelHandle> handles;
    for (const Mesh& mesh : meshes) handles.push_back(accel.push(mesh));
    accel.sync();
    for (std::size_t i = 0; i < handles.size(); ++i)
        expect_reference(download_geometry(accel, handles[i]), meshes[i], quality());
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
    SwTlas accel(context(), options());
    std::vector<Mesh> meshes;
    std::vector<AccelHandle> handles;
    for (const uint n : {most - 1, 3u, 5 * most, most, 2u, most + 1, 7u}) {
        meshes.push_back(make_soup(n, n, 0.05f));
        handles.push_back(accel.push(meshes.back()));
    }
    accel.sync();
    for (std::size_t i = 0; i < meshes.size(); ++i)
        expect_reference(download_geometry(accel, handles[i]), meshes[i], quality());
}

// A triangle beside each power of two, along the axes in turn, and behind these `count` that lie close together.
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
    // Others make it less deep.
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

TEST_P(SwBuild, EqualCentroidsAreSplitByPosition) {
    const Mesh mesh = equal_triangles(1000);
    const BuiltTree tree = checked_tree(mesh);
    const std::vector<LeafBox> boxes = leaf_boxes(tree, mesh);
    EXPECT_LE(has_records(tree) ? check_tree(tree.bvh, tree.records, boxes).depth
                                : check_tree(tree.bvh, tree.nodes, boxes).depth,
              10u);
}

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

TEST_P(SwBuild, ASecondBuildIsBitIdentical) {
    const Mesh mesh = make_soup(50'000, 5, 0.02f);
    BuiltTree trees[2];
    for (BuiltTree& tree : trees) {
        SwTlas accel(context(), options());
        const AccelHandle handle = accel.push(mesh);
        accel.sync();
        tree = download_geometry(accel, handle);
    }
    EXPECT_TRUE(same_bytes(trees[0].nodes, trees[1].nodes));
    EXPECT_TRUE(same_bytes(trees[0].triangles, trees[1].triangles));
    EXPECT_TRUE(same_bytes(trees[0].records, trees[1].records));
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

// The area of all boxes, but for the root's: what a stray triangle must not change.
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
    // In planes of grids its topmost boxes lie far apart.
    const bool is_exact = std::get<Layout>(GetParam()) == Layout::bvh2;
    EXPECT_LT(area_below_root(tree, mesh), is_exact ? 1.2 * area : INFINITY);

    // Beside others in a batch, of which it is a small part, and which keep their order.
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

// Triangles of many sizes and shapes, as architecture has: long walls, panels, small parts.
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
            sah[static_cast<std::size_t>(quality)] = sah_of(tree, leaf_boxes(tree, mesh));
        }
        std::printf("surface-area cost of %zu triangles: fast %.2f, high %.2f, ploc %.2f\n", mesh.triangles.size(),
                    sah[0], sah[1], sah[2]);
        // On a sphere, whose triangles are alike, nodes of eight leave little to gain.
        const bool is_wide = GetParam() == Layout::compressed8;
        EXPECT_LT(sah[1], (is_wide ? 0.99 : 0.97) * sah[0]);
        EXPECT_LT(sah[2], (is_wide ? 0.995 : 0.99) * sah[0]);
    }
}

}  // namespace
}  // namespace twinray
