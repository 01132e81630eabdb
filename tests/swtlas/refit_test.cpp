// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "tests/support/seam.h"
#include "tests/support/sw_build.h"

namespace twinray {
namespace {

using namespace test;

class SwRefit : public SwBuildTest {};
INSTANTIATE_TEST_SUITE_P(Every, SwRefit, builds_of_the_default_layout(), name_of_build);
INSTANTIATE_TEST_SUITE_P(Full, SwRefit, builds_of_other_layouts(), name_of_build);

void expect_same_topology(const BuiltTree& after, const BuiltTree& before) {
    ASSERT_EQ(after.nodes.size(), before.nodes.size());
    for (std::size_t i = 0; i < before.nodes.size(); ++i) {
        EXPECT_EQ(after.nodes[i].child0, before.nodes[i].child0);
        EXPECT_EQ(after.nodes[i].child1, before.nodes[i].child1);
    }
    ASSERT_EQ(after.records.size(), before.records.size());
    for (std::size_t i = 0; i < before.records.size(); ++i) {
        const CompressedRecord &now = after.records[i], &then = before.records[i];
        EXPECT_EQ(is_leaf(now), is_leaf(then));
        EXPECT_EQ(now.a.w, then.a.w);
    }
}

void expect_leaves_of(std::span<const CompressedRecord> records, std::span<const vec3> positions,
                      std::span<const uvec3> triangles) {
    BuildTree source{};
    source.positions = Floats::to(&positions.data()->x);
    source.indices = Uints::to(&triangles.data()->x);
    for (const CompressedRecord& record : records) {
        if (!is_leaf(record)) continue;
        const Leaf leaf = leaf_of(record);
        const CompressedRecord right = encode_boxed_leaf(source, leaf, boxed_leaf(source, leaf));
        EXPECT_EQ(std::memcmp(&record, &right, sizeof right), 0) << "primitive " << leaf.first;
    }
}

TEST_P(SwRefit, ARefittedSceneTreeIsSoundAndKeepsItsTopology) {
    const Mesh mesh = make_soup(10, 1);
    for (const std::size_t count : {1u, 2u, 3u, 255u, 256u, 257u, 1000u}) {
        SwTlas accel(context(), options());
        const AccelHandle handle = accel.push(mesh, scattered(count, 1));
        accel.sync();
        accel.update_transforms(handle, scattered(count, 2));  // the first move rebuilds
        accel.sync();
        const BuiltTree before = download_scene(accel);
        const std::vector<Transform> moved = scattered(count, 3);
        accel.update_transforms(handle, moved);
        accel.sync();
        const BuiltTree after = download_scene(accel);
        expect_sound(after, instance_boxes(mesh, moved, options()), text(count, " instances"));
        expect_same_topology(after, before);
    }
}

// Expects the box of all points under the map, in float64.
void expect_around(const BuiltTree& scene, const std::vector<vec3>& points, const Transform& map, double slack) {
    for (int axis = 0; axis < 3; ++axis) {
        double lo = INFINITY, hi = -INFINITY;
        for (const vec3& point : points) {
            const double x = dot(dvec4(map.rows[static_cast<std::size_t>(axis)]), dvec4(point, 1));
            lo = std::min(lo, x);
            hi = std::max(hi, x);
        }
        EXPECT_LE(double{scene.bvh.lo[axis]}, lo) << "axis " << axis;
        EXPECT_GE(double{scene.bvh.hi[axis]}, hi) << "axis " << axis;
        EXPECT_LT(scene.bvh.hi[axis] - scene.bvh.lo[axis], hi - lo + slack) << "axis " << axis;
    }
}

TEST_P(SwRefit, ARotatedInstanceHasABoxAroundWhatItsGeometryHasBecome) {
    const Transform map =
        Transform::translation({3, 0, -2}) * Transform::of(glm::rotate(glm::mat4(1), 0.8f, glm::vec3(0.6f, 0, 0.8f)));
    Mesh ball = make_icosphere(4);
    SwTlas accel(context(), options());
    const AccelHandle handle = accel.push(ball, std::vector<Transform>(2, map));  // a lone one has a loose box
    accel.sync();
    expect_around(download_scene(accel), ball.positions, map, 0.5);
    for (vec3& point : ball.positions) point = point * vec3(1, 2, 1) + vec3(0, 0.5f * point.x, 0);
    accel.update_vertices(handle, ball.positions);
    accel.sync();
    expect_around(download_scene(accel), ball.positions, map, 0.9);
}

// Each triangle is there three times, so that its number decides equal t, in whichever order the trees are.
TEST_P(SwRefit, ARefittedGeometryHasTheHitsOfAFreshOneToTheLastBit) {
    Mesh mesh = make_soup(400, 1, 0.3f);
    const std::vector<uvec3> once = mesh.triangles;
    for (int copy = 0; copy < 2; ++copy) mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
    std::mt19937 random(7);
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    SwTlas refitted(context(), options());
    const AccelHandle handle = refitted.push(mesh);
    refitted.sync();
    const Mesh other = make_soup(400, 2, 0.3f);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        mesh.positions[i] = 0.9f * mesh.positions[i] + 0.1f * other.positions[i];
    refitted.update_vertices(handle, mesh.positions);
    SwTlas fresh(context(), options());
    fresh.push(mesh);
    std::vector<Ray> rays;
    std::uniform_real_distribution<float> draw(-1, 1);
    const auto point = [&] { return vec3(draw(random), draw(random), draw(random)); };
    for (int i = 0; i < 10'000; ++i) rays.push_back({2.0f * point(), 0, point(), INFINITY});
    const std::vector<Hit> hits = refitted.closest_hits(rays);
    EXPECT_TRUE(same_bytes(hits, fresh.closest_hits(rays)));
    EXPECT_GT(std::ranges::count(hits, 1u, &Hit::hit), 100);
}

TEST_P(SwRefit, RotatedBoxesLieInTheirBox) {
    const Transform map = Transform::of(glm::rotate(glm::mat4(1), 0.8f, glm::vec3(0.6f, 0, 0.8f)));
    std::vector<Bounds> boxes;
    std::vector<vec3> corners;
    for (const vec3& center : make_icosphere(2).positions) {
        boxes.push_back({center - 0.05f, center + 0.05f});
        for (uint i = 0; i < 8; ++i)
            corners.push_back(center + 0.05f * vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    }
    SwTlas accel(context(), options());
    accel.push(BoxesView{"boxes", boxes}, std::vector<Transform>(2, map));
    accel.sync();
    for (vec3& corner : corners) corner *= 1 - 1e-6f;  // centres and halves were added in float32
    expect_around(download_scene(accel), corners, map, 0.6);
}

TEST_P(SwRefit, ARefittedGeometryIsSoundAndKeepsItsTopology) {
    SwTlas accel(context(), options());
    std::vector<Mesh> meshes;
    std::vector<AccelHandle> handles;
    std::vector<BuiltTree> before;
    for (const uint n : {1u, 2u, 3u, 255u, 256u, 257u, 1000u}) meshes.push_back(make_soup(n, n));
    const std::size_t soups = meshes.size();
    for (const uint level : {0u, 2u, 5u}) meshes.push_back(make_icosphere(level));  // leaves of two triangles
    meshes.push_back(test::with_seam(make_icosphere(3)));
    for (const Mesh& mesh : meshes) handles.push_back(accel.push(mesh));
    const std::vector<Mesh> pushed = meshes;
    accel.sync();
    for (const AccelHandle handle : handles) before.push_back(download_geometry(accel, handle));
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        if (i < soups) meshes[i].positions = make_soup(static_cast<uint>(meshes[i].triangles.size()), 77).positions;
        for (vec3& position : meshes[i].positions) position = position * 0.9f + vec3(0.1f * position.y, 0, 0.05f);
        meshes[i].positions[1] = meshes[i].positions[0];  // a triangle that has both has no area
        if (meshes[i].positions.size() > 100) meshes[i].positions[100].y = NAN;
        accel.update_vertices(handles[i], meshes[i].positions);
    }
    accel.sync();
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const BuiltTree after = download_geometry(accel, handles[i]);
        expect_sound(after, meshes[i], &pushed[i]);
        expect_same_topology(after, before[i]);
        EXPECT_EQ(VkDeviceAddress{after.bvh.nodes.address}, VkDeviceAddress{before[i].bvh.nodes.address});
        const std::vector<vec3> positions = built(meshes[i], &pushed[i]);
        if (has_records(after)) {
            expect_leaves_of(after.records, positions, meshes[i].triangles);
            continue;
        }
        std::vector<uint> order;
        for (const BvhTriangle& triangle : before[i].triangles) order.push_back(triangle.primitive_index);
        EXPECT_TRUE(same_bytes(after.triangles, reference::encode_triangles(positions, meshes[i].triangles, order)));
    }
}

TEST_P(SwRefit, TheCostOnTheDeviceIsThatOfTheChecker) {
    for (const uint n : {1u, 2u, 3u, 256u, 257u, 258u, 1000u, 70'000u}) {
        SwTlas accel(context(), options());
        Mesh mesh = make_soup(n, 5, 0.1f);
        const std::vector<Transform> transforms = scattered(std::min(n, 1000u), n);
        const AccelHandle handle = accel.push(mesh, transforms);
        accel.sync();
        EXPECT_EQ(accel.sah(handle), std::nullopt) << "not measured before its vertices move";
        const BuiltTree top = download_scene(accel);
        const double expected = sah_of(top, instance_boxes(mesh, transforms, options()));
        EXPECT_NEAR(*accel.sah(), expected, 1e-5 * expected) << n;
        for (const uint seed : {6u, 7u}) {
            mesh.positions = make_soup(n, seed, 0.1f).positions;
            if (n > 3) mesh.positions[5].x = INFINITY;
            accel.update_vertices(handle, mesh.positions);
            accel.sync();
            const BuiltTree tree = download_geometry(accel, handle);
            const double cost = sah_of(tree, leaf_boxes(tree, mesh));
            EXPECT_NEAR(*accel.sah(handle), cost, 1e-5 * cost) << n;
            EXPECT_EQ(accel.sah_if_ready(handle), accel.sah(handle));
        }
    }
}

}  // namespace
}  // namespace twinray
