// SPDX-License-Identifier: MIT
#include <twinray/geometry.h>

#include <map>

#include <twinray/scene.h>

#include "engine/scene/mesh.h"
#include "tests/scene/temp_dir.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::test {
namespace {

double signed_volume(const Mesh& mesh) {
    double volume = 0;
    for (const uvec3& t : mesh.triangles)
        volume += double(dot(mesh.positions[t.x], cross(mesh.positions[t.y], mesh.positions[t.z]))) / 6;
    return volume;
}

// Every directed edge has its opposite exactly once.
bool is_closed(const Mesh& mesh) {
    std::map<std::pair<uint, uint>, int> edges;
    for (const uvec3& t : mesh.triangles)
        for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    for (const auto& [edge, count] : edges) {
        const auto opposite = edges.find({edge.second, edge.first});
        if (count != 1 || opposite == edges.end() || opposite->second != 1) return false;
    }
    return true;
}

vec3 face_normal(const Mesh& mesh, std::size_t triangle) {
    const uvec3 t = mesh.triangles[triangle];
    return normalize(cross(mesh.positions[t.y] - mesh.positions[t.x], mesh.positions[t.z] - mesh.positions[t.x]));
}

TEST(Shapes, TheQuadFacesAlongTheCrossOfItsEdges) {
    const Mesh quad = make_quad({1, 1, 1}, {2, 0, 0}, {0, 3, 0});
    EXPECT_EQ(quad.triangles.size(), 2u);
    EXPECT_EQ(face_normal(quad, 0), vec3(0, 0, 1));
    EXPECT_EQ(face_normal(quad, 1), vec3(0, 0, 1));
    EXPECT_EQ(quad.normals, std::vector<vec3>(4, vec3(0, 0, 1)));
    EXPECT_EQ(bounds_of(quad).hi, vec3(3, 4, 1));
}

TEST(Shapes, TheBoxFacesOutwards) {
    const Mesh box = make_box({-1, -2, -3}, {1, 2, 3});
    EXPECT_EQ(box.triangles.size(), 12u);
    EXPECT_NEAR(signed_volume(box), 48, 1e-5);
    EXPECT_EQ(bounds_of(box).lo, vec3(-1, -2, -3));
    EXPECT_EQ(bounds_of(box).hi, vec3(1, 2, 3));
    for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(face_normal(box, i), box.normals[box.triangles[i].x]);
}

TEST(Shapes, TheIcosphereIsClosedRoundAndFacesOutwards) {
    for (const uint subdivisions : {0u, 1u, 4u}) {
        const Mesh sphere = make_icosphere(subdivisions, 2);
        EXPECT_EQ(sphere.triangles.size(), std::size_t(20) << 2 * subdivisions);
        EXPECT_EQ(sphere.positions.size(), (std::size_t(10) << 2 * subdivisions) + 2);
        EXPECT_TRUE(is_closed(sphere));
        EXPECT_GT(signed_volume(sphere), 0);
        for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
            EXPECT_NEAR(length(sphere.positions[i]), 2, 1e-6);
            EXPECT_NEAR(length(sphere.normals[i] * 2.0f - sphere.positions[i]), 0, 1e-6);
        }
    }
    EXPECT_NEAR(signed_volume(make_icosphere(4, 2)), 33.51, 0.15);
    expect_error("13 subdivisions; the limit is 12", [] { make_icosphere(13); });
}

TEST(Shapes, TheGridCoversTheUnitSquareFacingUp) {
    const Mesh grid = make_grid(4, 3);
    EXPECT_EQ(grid.triangles.size(), 24u);
    EXPECT_EQ(grid.positions.size(), 20u);
    EXPECT_EQ(grid.uvs.size(), 20u);
    EXPECT_EQ(bounds_of(grid).lo, vec3(0));
    EXPECT_EQ(bounds_of(grid).hi, vec3(1, 0, 1));
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(face_normal(grid, i), vec3(0, 1, 0));
    EXPECT_GT(bounds_of(make_grid(9, 9, 0.5f, 7)).hi.y, 0.25f);
    expect_error("grid: 0 x 3 cells", [] { make_grid(0, 3); });
    expect_error("fit into 32 bits", [] { make_grid(100000, 100000); });
}

TEST(Shapes, TheSoupIsSeparateTrianglesOfTheSizeAsked) {
    const Mesh soup = make_soup(500, 42, 0.25f);
    EXPECT_EQ(soup.positions.size(), 1500u);
    for (const uvec3& t : soup.triangles) EXPECT_LE(length(soup.positions[t.x] - soup.positions[t.y]), 0.5f);
    EXPECT_LT(length(bounds_of(soup).center() - vec3(0.5f)), 0.1f);
}

TEST(Shapes, TheSameSeedGivesTheSameBits) {
    EXPECT_EQ(make_soup(10, 1).positions, make_soup(10, 1).positions);
    EXPECT_NE(make_soup(10, 1).positions, make_soup(10, 2).positions);
    EXPECT_EQ(make_grid(5, 5, 1, 3).positions, make_grid(5, 5, 1, 3).positions);
    // The generator is part of the promise: recorded seeds must mean the same scene next year.
    EXPECT_EQ(make_grid(1, 1, 1, 5489).positions[0].y, static_cast<float>(3499211612u >> 8) * 0x1p-24f);
}

TEST(Shapes, TheCornellBoxHasALightAMetalAndAGlassThing) {
    const Scene scene = cornell_box_scene();
    EXPECT_EQ(scene.instances.size(), 8u);
    EXPECT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(bounds_of(scene).lo, vec3(-1));
    EXPECT_EQ(bounds_of(scene).hi, vec3(1));
    bool has_light = false, has_metal = false, has_glass = false;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        EXPECT_NO_THROW(check_indices(mesh));
        const Material& material = scene.materials.at(mesh.material(0));
        has_light |= material.emission.x > 1;
        has_metal |= material.metallic == 1;
        has_glass |= material.transmission == 1;
    }
    EXPECT_TRUE(has_light && has_metal && has_glass);
}

TEST(Shapes, TheCornellBoxFacesInwards) {
    const Scene scene = cornell_box_scene();
    for (std::size_t i = 0; i < 6; ++i) {  // walls and light; the camera looks in from +z
        const Mesh& mesh = scene.meshes[i];
        EXPECT_LT(dot(mesh.normals[0], mesh.positions[mesh.triangles[0].x]), 0) << mesh.name;
    }
}

}  // namespace
}  // namespace twinray::test
