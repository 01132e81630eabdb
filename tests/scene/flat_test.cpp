// SPDX-License-Identifier: MIT
// Placements that lose one direction: the rest is shown, by vertices that are flat themselves.
#include <numbers>

#include <gtest/gtest.h>

#include <glm/ext/matrix_transform.hpp>

#include "engine/scene/flat.h"
#include "engine/scene/rig.h"
#include "tests/scene/gltf_builder.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::test {
namespace {

constexpr float HALF = std::numbers::sqrt2_v<float> / 2;

// Mesh 0, a tetrahedron with an edge along each axis.
GltfBuilder tetrahedron() {
    GltfBuilder gltf = one_triangle();
    const int positions = gltf.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
    const int indices = gltf.add_indices({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
    gltf.primitive() = {{"attributes", {{"POSITION", positions}}}, {"indices", indices}};
    return gltf;
}

std::vector<vec3> world_positions(const Scene& scene, std::size_t instance) {
    std::vector<vec3> all;
    for (const vec3& position : scene.meshes[scene.instances[instance].mesh].positions)
        all.push_back(transform_point(scene.instances[instance].transform, position));
    return all;
}

void expect_all_near(const std::vector<vec3>& found, const std::vector<vec3>& expected, float tolerance) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(found[i][axis], expected[i][axis], tolerance) << i;
}

TEST(Flat, APlacementWithAnInverseIsLeftAlone) {
    Mesh mesh;
    mesh.positions = {{1, 2, 3}};
    for (const Transform& transform : {Transform{}, Transform::scaling({1, 1, 1e-30f}), Transform::scaling({-1, 1, 1}),
                                       Transform::scaling(vec3(0)), Transform::scaling({1, 0, 0})})
        EXPECT_FALSE(flatten(mesh, transform));
    EXPECT_EQ(mesh.positions[0], vec3(1, 2, 3));
}

TEST(Flat, AFlatMeshStandsWhereItsPlacementPutsIt) {
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(1, 2, 3));
    const glm::dmat4 matrices[] = {
        glm::scale(glm::dmat4(1), glm::dvec3(1, 1, 0)), glm::scale(glm::dmat4(1), glm::dvec3(-3, 0, 1e-3)),
        turned * glm::scale(glm::dmat4(1), glm::dvec3(0, 2, 5)) * glm::transpose(turned),
        glm::translate(glm::dmat4(1), glm::dvec3(3, 4, 5)) * glm::scale(glm::dmat4(1), glm::dvec3(1, 1, 0)) * turned};
    for (const glm::dmat4& matrix : matrices) {
        const Transform given = transform_of(matrix);
        Mesh mesh;
        mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-2, 3, 4}};
        std::vector<vec3> expected, found;
        for (const vec3& position : mesh.positions) expected.push_back(transform_point(given, position));
        const std::optional<Transform> placed = flatten(mesh, given);
        ASSERT_TRUE(placed);
        EXPECT_EQ(fault_of(*placed), "");
        EXPECT_GT(determinant(*placed), 0);
        for (const vec3& position : mesh.positions) found.push_back(transform_point(*placed, position));
        expect_all_near(found, expected, 1e-5f);
    }
}

TEST(Flat, NormalsAndTangentsGoWithThePlane) {
    Mesh mesh;
    mesh.positions = std::vector(3, vec3(0, 0, 1));
    mesh.normals = {{0.6f, 0, 0.8f}, {0.6f, 0, -0.8f}, {1, 0, 0}};
    mesh.tangents = {{0.8f, 0, -0.6f, -1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
    ASSERT_TRUE(flatten(mesh, Transform::scaling({1, 1, 0})));
    EXPECT_EQ(mesh.positions[0], vec3(0));
    EXPECT_EQ(mesh.normals, (std::vector<vec3>{{0, 0, 1}, {0, 0, -1}, {0, 0, 1}}));
    EXPECT_EQ(mesh.tangents, (std::vector<vec4>{{1, 0, 0, -1}, {0, 1, 0, 1}, {0, 0, 0, 1}}));
}

TEST(Flat, NodesOfEveryKindShowWhatIsLeft) {
    GltfBuilder gltf = tetrahedron();
    gltf.root["nodes"][0]["scale"] = {1, 1, 0};
    gltf.add_node({{"mesh", 0}});
    gltf.add_node({{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}});
    const int child = gltf.append("nodes", {{"mesh", 0}, {"rotation", {0, HALF, 0, HALF}}});
    gltf.add_node({{"scale", {1, 1, 0}}, {"children", {child}}});
    const json attributes = {{"SCALE", gltf.add_floats("VEC3", {0, 1, 1, 1, 1, 0})}};
    gltf.add_node({{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
    const Scene scene = gltf.load();
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.instances.size(), 6u);
    EXPECT_EQ(scene.meshes.size(), 5u);  // whole, and along z (two share it), y, x, and x but for a rounding
    std::vector<std::vector<vec3>> expected = {
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
        {{5, 0, 0}, {6, 0, 0}, {5, 0, 0}, {5, 0, 1}}, {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}},
        {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}};
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        EXPECT_EQ(fault_of(scene.instances[i].transform), "");
        const std::vector<vec3> found = world_positions(scene, i);
        const auto same = [&](const std::vector<vec3>& points) {
            for (std::size_t k = 0; k < points.size(); ++k)
                if (!(length(points[k] - found[k]) < 1e-6f)) return false;
            return true;
        };
        const auto match = std::ranges::find_if(expected, same);
        ASSERT_NE(match, expected.end()) << i;
        expected.erase(match);
    }
}

TEST(Flat, FarFromTheOriginToo) {
    GltfBuilder gltf = tetrahedron();
    gltf.root["nodes"][0]["scale"] = {1, 1, 0};
    gltf.root["nodes"][0]["translation"] = {500000, 5400000, 100};
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.instances.size(), 1u);
    const std::vector<vec3> found = world_positions(scene, 0);
    const dvec3 corner = scene.origin + dvec3(found[1]);
    EXPECT_NEAR(corner.x, 500001, 1e-3);
    EXPECT_NEAR(corner.y, 5400000, 1e-3);
    EXPECT_NEAR(corner.z, 100, 1e-3);
}

TEST(Flat, MorphTargetsMoveWithinThePlane) {
    GltfBuilder gltf = tetrahedron();
    gltf.primitive()["targets"] = {{{"POSITION", gltf.add_floats("VEC3", {0, 0, 0, 1, 2, 3, 0, 0, 0, 0, 0, 0})}}};
    gltf.root["nodes"][0]["scale"] = {1, 1, 0};
    gltf.root["nodes"][0]["weights"] = {0.5};
    expect_all_near(world_positions(gltf.load(), 0), {{0, 0, 0}, {1.5f, 1, 0}, {0, 1, 0}, {0, 0, 0}}, 1e-6f);
}

// While an animation scales a node through 0, it is a thousandth as thick as large, and always has an inverse.
TEST(Flat, AnAnimationThroughZeroKeepsItShown) {
    GltfBuilder gltf = tetrahedron();
    gltf.root["nodes"][0]["scale"] = {1, 1, 0};
    gltf.animate(0, "scale", {0, 1, 2}, "VEC3", {1, 1, 1, 1, 1, 0, 2, 2, -2});
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(fault_of(scene.instances[0].transform), "");
    for (const double seconds : {0.0, 0.5, 1.0, 2.0}) {
        const Transform placed = instance_transforms(*scene.rig, pose_at(*scene.rig, 0, seconds))[0];
        EXPECT_EQ(fault_of(placed), "") << seconds;
        const double z = seconds <= 1 ? std::max(1 - seconds, 0x1p-10) : -2;
        EXPECT_NEAR(transform_point(placed, {0, 0, 1}).z, z, 1e-6) << seconds;
    }
}

}  // namespace
}  // namespace twinray::test
