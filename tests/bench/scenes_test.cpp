// SPDX-License-Identifier: MIT
#include "bench/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "validation/leaks/closed_mesh.h"
#include "tests/scene/temp_dir.h"

namespace twinray::bench {
namespace {

using test::expect_error;

TEST(DisplacedSphere, HasTheGeodesicCountsAndIsClosed) {
    for (const uint frequency : {1u, 2u, 3u, 7u, 16u}) {
        SCOPED_TRACE(frequency);
        const Mesh mesh = make_displaced_sphere(frequency);
        EXPECT_EQ(mesh.triangles.size(), 20u * frequency * frequency);
        EXPECT_EQ(mesh.positions.size(), 10u * frequency * frequency + 2);
        EXPECT_FALSE(find_open_edge(Geometry64(mesh)).has_value());
    }
}

TEST(DisplacedSphere, FacesOutwardsAndHasReliefWithinItsRadii) {
    const Mesh mesh = make_displaced_sphere(40);
    double least = INFINITY, most = 0;
    for (const vec3& position : mesh.positions) {
        least = std::min(least, double(length(position)));
        most = std::max(most, double(length(position)));
    }
    EXPECT_GE(least, 0.75);
    EXPECT_LE(most, 1.25);
    EXPECT_GT(most - least, 0.1);
    for (const uvec3& t : mesh.triangles) {
        const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        ASSERT_GT(dot(cross(b - a, c - a), a + b + c), 0);
    }
}

TEST(DisplacedSphere, TheFrequencyIsTheNearest) {
    EXPECT_EQ(geodesic_frequency(20), 1u);
    EXPECT_EQ(geodesic_frequency(1'310'720), 256u);
    EXPECT_EQ(geodesic_frequency(100'000), 71u);
    EXPECT_EQ(geodesic_frequency(1), 1u);
}

TEST(BenchScenes, SphereHasAboutAsManyTriangles) {
    for (const char* name : {"sphere:1000", "sphere:1e3"}) {
        const BenchScene scene = make_scene(name);
        EXPECT_EQ(scene.name, name);
        EXPECT_EQ(count_mesh_triangles(scene.scene), 980u);
    }
}

TEST(BenchScenes, SoupHasSeparateTrianglesAboutAsLargeAsTheirShareOfTheCube) {
    const BenchScene scene = make_scene("soup:1000");
    const Mesh& mesh = scene.scene.meshes.at(0);
    EXPECT_EQ(mesh.triangles.size(), 1000u);
    EXPECT_EQ(mesh.positions.size(), 3000u);
    for (const uvec3& t : mesh.triangles) {
        const Bounds bounds = bounds_of(
            MeshView("", std::span(mesh.positions).subspan(t.x, 3), std::span<const uvec3>(mesh.triangles).first(1)));
        const vec3 size = bounds.size();
        ASSERT_LE(std::max({size.x, size.y, size.z}), 0.2001f);  // twice the side of a thousandth of the cube
    }
}

TEST(BenchScenes, InstancesArePlacedApartAndAtRandom) {
    const BenchScene scene = make_scene("instances:27x320");
    ASSERT_EQ(scene.scene.meshes.size(), 1u);
    ASSERT_EQ(scene.scene.instances.size(), 27u);
    EXPECT_EQ(count_mesh_triangles(scene.scene), 320u);
    EXPECT_EQ(count_triangles(scene.scene), 27u * 320u);
    std::set<float> scales;
    for (const Instance& instance : scene.scene.instances) {
        EXPECT_EQ(fault_of(instance.transform), "");
        const double scale = std::cbrt(determinant(instance.transform));
        EXPECT_GT(scale, 0.6 * 0.88 / 3);  // cbrt of the least stretch, 0.7
        EXPECT_LT(scale, 1.2 * 1.1 / 3);   // and of the largest, 1.3
        scales.insert(static_cast<float>(scale));
        for (const vec4& row : instance.transform.rows) EXPECT_LE(std::abs(row.w), 1);
    }
    EXPECT_EQ(scales.size(), 27u);
}

TEST(BenchScenes, TheSameNameGivesTheSameBits) {
    for (const char* name : {"sphere:500", "soup:50", "instances:5x80"}) {
        SCOPED_TRACE(name);
        const Scene a = make_scene(name).scene, b = make_scene(name).scene;
        EXPECT_EQ(a.meshes.at(0).positions, b.meshes.at(0).positions);
        EXPECT_EQ(a.meshes.at(0).triangles, b.meshes.at(0).triangles);
        for (std::size_t i = 0; i < a.instances.size(); ++i)
            EXPECT_EQ(a.instances[i].transform, b.instances[i].transform);
    }
}

TEST(BenchScenes, TheCameraFramesThem) {
    const BenchScene scene = make_scene("sphere:500");
    const Bounds all = bounds_of(scene.scene);
    EXPECT_NEAR(length(scene.framed.size()), 0.7 * length(all.size()), 1e-5);
    EXPECT_NEAR(length(scene.framed.center() - all.center()), 0, 1e-5);
}

TEST(BenchScenes, BadNamesGetOneClearError) {
    expect_error("scene 'sphere:many': 'many' is not a whole number from 20 to 50000000",
                 [] { make_scene("sphere:many"); });
    expect_error("'19' is not", [] { make_scene("sphere:19"); });
    expect_error("'50000001' is not", [] { make_scene("soup:50000001"); });
    expect_error("'20.5' is not", [] { make_scene("soup:20.5"); });
    expect_error("'nan' is not", [] { make_scene("sphere:nan"); });
    expect_error("'' is not", [] { make_scene("sphere:"); });
    expect_error("'100 ' is not", [] { make_scene("sphere:100 "); });
    expect_error("instances:KxN needs two numbers", [] { make_scene("instances:100"); });
    expect_error("'0' is not a whole number from 1 to 1000000", [] { make_scene("instances:0x100"); });
    expect_error("no_such_file.ply", [] { make_scene("no_such_file.ply"); });
}

}  // namespace
}  // namespace twinray::bench
