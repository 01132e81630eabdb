// Placement: the node tree, instancing, cameras and lights. Placements that lose one direction show the rest, by
// vertices that are flat themselves.
#include "tests/scene/gltf_builder.h"

#include <numbers>

#include <glm/ext/matrix_transform.hpp>
#include "engine/scene/rig.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::test {
namespace {

TEST(GltfNodes, TransformsMultiplyDownTheTree) {
    GltfBuilder gltf = one_triangle();
    gltf.root["nodes"] = {
        {{"children", {1}}, {"translation", {10, 0, 0}}, {"rotation", {0, 0, 0.70710678, 0.70710678}}},
        {{"mesh", 0}, {"translation", {0, 1, 0}}, {"scale", {2, 3, 4}}}};
    const Transform transform = gltf.load().instances[0].transform;
    const vec3 moved =
        transform_point(transform, vec3(1, 1, 1));  // scaled (2, 3, 4), moved (2, 4, 4), turned (-4, 2, 4)
    EXPECT_NEAR(moved.x, 6, 1e-6);
    EXPECT_NEAR(moved.y, 2, 1e-6);
    EXPECT_NEAR(moved.z, 4, 1e-6);
}

TEST(GltfNodes, MatricesAreColumnMajor) {
    GltfBuilder gltf = one_triangle();
    gltf.root["nodes"][0]["matrix"] = {1, 2, 3, 0, 4, 5, 7, 0, 8, 9, 11, 0, 12, 13, 14, 1};
    const Transform expected{{vec4(1, 4, 8, 12), vec4(2, 5, 9, 13), vec4(3, 7, 11, 14)}};
    EXPECT_EQ(gltf.load().instances[0].transform, expected);
}

TEST(GltfNodes, QuaternionsOfAnyLengthOnlyRotate) {
    GltfBuilder gltf = one_triangle();
    gltf.root["nodes"][0]["rotation"] = {0, 5, 0, 0};
    EXPECT_EQ(gltf.load().instances[0].transform, Transform::scaling({-1, 1, -1}));
}

TEST(GltfNodes, MirroringIsKept) {
    GltfBuilder gltf = one_triangle();
    gltf.root["nodes"][0]["scale"] = {-1, 1, 1};
    EXPECT_EQ(determinant(gltf.load().instances[0].transform), -1);
}

TEST(GltfNodes, AnInstanceWithoutAreaIsSkippedByName) {
    GltfBuilder gltf = one_triangle();
    gltf.add_node({{"name", "flat"}, {"mesh", 0}, {"scale", {1, 0, 0}}});
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.instances.size(), 1u);
    EXPECT_TRUE(has_warning(scene, "node 1 'flat': skipped 1 of 1 placements"));
}

TEST(GltfNodes, ANodeOfTwoParentsIsShownBelowTheFirst) {
    GltfBuilder gltf = one_triangle();
    gltf.root["scenes"][0]["nodes"] = json::array();
    for (const double x : {1, 2}) gltf.add_node({{"translation", {x, 0, 0}}, {"children", {0}}});
    gltf.add_node({{"mesh", 0}, {"translation", {7, 0, 0}}});
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.instances[0].transform.rows[0].w + scene.instances[1].transform.rows[0].w, 8);
    EXPECT_TRUE(has_warning(scene, "node 0 'node': is a child of both node 1 and node 2, and shown once"));
}

TEST(GltfNodes, AChildThatIsListedTwiceIsShownOnce) {
    GltfBuilder gltf = one_triangle();
    gltf.root["scenes"][0]["nodes"] = json::array();
    gltf.add_node({{"children", {0, 0}}});
    EXPECT_EQ(gltf.load().instances.size(), 1u);
}

TEST(GltfNodes, OnlyTheDefaultSceneIsShown) {
    GltfBuilder gltf = one_triangle();
    gltf.append("nodes", {{"mesh", 0}});
    EXPECT_EQ(gltf.load().instances.size(), 1u);
}

TEST(GltfNodes, WithoutADefaultTheFirstSceneIsShown) {
    GltfBuilder gltf = one_triangle();
    gltf.root.erase("scene");
    gltf.append("nodes", {{"name", "other"}, {"mesh", 0}});
    Scene scene = gltf.load();
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.instances[0].name, "node");
    EXPECT_TRUE(scene.warnings.empty());
    gltf.root["scenes"].push_back({{"nodes", {1}}});
    scene = gltf.load();
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.instances[0].name, "node");
    EXPECT_TRUE(has_warning(scene, "none of the 2 scenes is the default; scene 0 is shown"));
    gltf.root["scene"] = 1;
    scene = gltf.load();
    ASSERT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.instances[0].name, "other");
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfNodes, WithoutScenesAllRootsAreShownWithTheirChildren) {
    GltfBuilder gltf = one_triangle();
    gltf.root.erase("scene");
    gltf.append("nodes", {{"mesh", 0}, {"children", {2}}});
    gltf.append("nodes", {{"mesh", 0}});
    for (const json& scenes : {json::array(), json()}) {
        gltf.root["scenes"] = scenes;
        if (scenes.is_null()) gltf.root.erase("scenes");
        EXPECT_EQ(gltf.load().instances.size(), 3u);
    }
}

// KHR_node_visibility hides meshes and lights below it, but not cameras.
TEST(GltfNodes, HiddenNodesShowNothingAndHideWhatIsBelow) {
    GltfBuilder gltf = one_triangle();
    gltf.root["extensionsUsed"] = gltf.root["extensionsRequired"] = {"KHR_node_visibility", "KHR_lights_punctual"};
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    gltf.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    const auto extensions = [](const json& visibility) {
        return json{{"KHR_node_visibility", visibility}, {"KHR_lights_punctual", {{"light", 0}}}};
    };
    const json hidden = {{"visible", false}}, shown = {{"visible", true}};
    gltf.add_node({{"name", "hidden"}, {"mesh", 0}, {"extensions", extensions(hidden)}, {"children", {4}}});
    gltf.add_node({{"name", "shown"}, {"mesh", 0}, {"extensions", extensions(shown)}});
    gltf.add_node({{"name", "unsaid"}, {"mesh", 0}, {"extensions", extensions(json::object())}});
    gltf.append("nodes", {{"mesh", 0}, {"camera", 0}, {"extensions", extensions(shown)}});
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.instances.size(), 3u);
    EXPECT_EQ(scene.instances[1].name, "shown");
    EXPECT_EQ(scene.instances[2].name, "unsaid");
    EXPECT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.cameras.size(), 1u);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfNodes, TheLastRowOfAMatrixMayBeRounded) {
    GltfBuilder gltf = one_triangle();
    json& matrix = gltf.root["nodes"][0]["matrix"];
    matrix = {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1};
    const Transform exact = gltf.load().instances[0].transform;
    for (const double last : {0.9999999, 1.0000001, 1 + 0x1p-15}) {
        matrix[15] = last;
        const Scene scene = gltf.load();
        EXPECT_TRUE(scene.warnings.empty());
        for (std::size_t row = 0; row < 3; ++row)
            for (int i = 0; i < 4; ++i)
                EXPECT_NEAR(scene.instances[0].transform.rows[row][i], exact.rows[row][i] / float(last), 1e-6) << last;
    }
    matrix[15] = 1;
    for (const std::size_t entry : {3u, 7u, 11u}) {
        matrix[entry] = entry == 7 ? -2e-9 : 1e-17;
        EXPECT_EQ(gltf.load().instances[0].transform, exact);
    }
    for (const auto& [entry, value] : {std::pair{3, 1e-3}, {7, -1e-4}, {11, 1.0}, {15, 0.999}, {15, 0.0}, {15, -1.0}}) {
        json wrong = matrix;
        wrong[std::size_t(entry)] = value;
        GltfBuilder bent = gltf;
        bent.root["nodes"][0]["matrix"] = wrong;
        expect_contains(bent.error(), "node 0 'node': matrix: the last row is ");
    }
}

// glTF keeps scales from cameras and lights, even 0: on a node that is shrunk to nothing, they have the node's place
// and turn.
TEST(GltfNodes, CamerasAndLightsOfNodesWithoutSizeStandAndTurnWithThem) {
    GltfBuilder gltf = one_triangle();
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", json::object()}}};
    gltf.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    gltf.add_node({{"translation", {1, 2, 3}}, {"scale", {0, 0, 0}}, {"children", {2}}});
    gltf.append("nodes", {{"translation", {9, 9, 9}},  // nothing of it is left
                          {"rotation", {0, 1, 0, 0}},
                          {"camera", 0},
                          {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    const Scene scene = gltf.load();
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].position, vec3(1, 2, 3));
    EXPECT_EQ(scene.lights[0].direction, vec3(0, 0, 1));
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].camera_to_world, (Transform{{vec4(-1, 0, 0, 1), vec4(0, 1, 0, 2), vec4(0, 0, -1, 3)}}));
}

TEST(GltfNodes, AThousandLevelsAreFine) {
    GltfBuilder gltf = one_triangle();
    gltf.root["nodes"] = json::array();
    for (int i = 0; i < 1000; ++i) gltf.append("nodes", i == 999 ? json{{"mesh", 0}} : json{{"children", {i + 1}}});
    EXPECT_EQ(gltf.load().instances.size(), 1u);
}

TEST(GltfNodes, GpuInstancingPlacesTheMeshOncePerElement) {
    GltfBuilder gltf = one_triangle();
    const int translations = gltf.add_floats("VEC3", {1, 0, 0, 2, 0, 0, 3, 0, 0});
    const int scales = gltf.add_floats("VEC3", {1, 1, 1, 2, 2, 2, 0, 0, 0});
    gltf.root["nodes"][0]["translation"] = {0, 5, 0};
    gltf.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", translations},
                                                                                    {"SCALE", scales}};
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.meshes.size(), 1u);
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(transform_point(scene.instances[1].transform, vec3(1, 0, 0)), vec3(4, 5, 0));
    EXPECT_TRUE(has_warning(scene, "skipped 1 of 3 placements"));
}

TEST(GltfNodes, CamerasStandWhereTheirNodesDoWithoutTheirScale) {
    GltfBuilder gltf = one_triangle();
    gltf.root["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}, {"aspectRatio", 2}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}}};
    gltf.add_node({{"camera", 0}, {"translation", {1, 2, 3}}, {"scale", {2, 2, 2}}});
    gltf.add_node({{"camera", 1}});
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].camera_to_world, Transform::translation({1, 2, 3}));
    EXPECT_EQ(scene.cameras[0].vertical_fov, 0.5f);
    EXPECT_EQ(scene.cameras[0].aspect, 2.0f);
    EXPECT_FALSE(scene.cameras[0].orthographic_half_height);
    EXPECT_EQ(scene.cameras[1].orthographic_half_height, 2.0f);
    EXPECT_EQ(scene.cameras[1].aspect, 1.5f);
}

TEST(GltfNodes, ACameraThatSeesNothingIsSkipped) {
    GltfBuilder gltf = one_triangle();
    gltf.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0}, {"znear", 0.1}}}}};
    gltf.add_node({{"camera", 0}});
    const Scene scene = gltf.load();
    EXPECT_TRUE(scene.cameras.empty());
    EXPECT_TRUE(has_warning(scene, "node 1: skipped its camera"));
}

TEST(GltfNodes, LightsShineAlongTheMinusZOfTheirNodes) {
    GltfBuilder gltf = one_triangle();
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"},
         {"color", {1, 0.5, 0}},
         {"intensity", 8},
         {"range", 7},
         {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}},
        {{"type", "point"}}};
    // This is half a turn about y, so that -z points along +z.
    gltf.add_node({{"translation", {1, 2, 3}},
                   {"rotation", {0, 1, 0, 0}},
                   {"scale", {3, 3, 3}},
                   {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    gltf.add_node({{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.lights.size(), 2u);
    const Light& spot = scene.lights[0];
    EXPECT_EQ(spot.kind, Light::Kind::spot);
    EXPECT_EQ(spot.color, vec3(8, 4, 0));
    EXPECT_EQ(spot.position, vec3(1, 2, 3));
    EXPECT_EQ(spot.direction, vec3(0, 0, 1));
    EXPECT_EQ(spot.range, 7);
    EXPECT_EQ(spot.inner_cone, 0.25f);
    EXPECT_EQ(spot.outer_cone, 0.5f);
    EXPECT_EQ(scene.lights[1].kind, Light::Kind::point);
    EXPECT_EQ(scene.lights[1].range, INFINITY);
}

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
