// SPDX-License-Identifier: MIT
#include "engine/scene/glb.h"

#include <cstring>

#include <nlohmann/json.hpp>

#include <twinray/scene.h>

#include "engine/core/files.h"
#include <twinray/geometry.h>
#include "tests/scene/temp_dir.h"

namespace twinray::test {
namespace {

constexpr Rgb red = {255, 0, 0}, grey = {188, 188, 188};

// The file's JSON, and its binary chunk.
struct Chunks {
    nlohmann::json json;
    Bytes binary;
};
Chunks chunks_of(const std::filesystem::path& file) {
    const Bytes bytes = read_file(file);
    std::uint32_t length = 0;
    std::memcpy(&length, &bytes[12], 4);
    return {nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + length),
            Bytes(bytes.begin() + 28 + length, bytes.end())};
}

Scene two_boxes(const Transform& second) {
    Scene scene;
    scene.materials.resize(1);
    scene.meshes.push_back(make_box({0, 0, 0}, {1, 2, 3}));
    scene.instances = {{"one", 0, {}}, {"two", 0, second}};
    return scene;
}

void expect_same_triangles(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.instances.size(), b.instances.size());
    for (std::size_t i = 0; i < a.instances.size(); ++i) {
        const Mesh &mesh_a = a.meshes[a.instances[i].mesh], &mesh_b = b.meshes[b.instances[i].mesh];
        ASSERT_EQ(mesh_a.triangles.size(), mesh_b.triangles.size());
        for (std::size_t t = 0; t < mesh_a.triangles.size(); ++t)
            for (int k = 0; k < 3; ++k)
                EXPECT_EQ(transform_point(a.instances[i].transform, mesh_a.positions[mesh_a.triangles[t][k]]),
                          transform_point(b.instances[i].transform, mesh_b.positions[mesh_b.triangles[t][k]]));
    }
}

TEST(Glb, OurOwnLoaderReadsTheSameTriangles) {
    const TempDir folder;
    const Transform turned = {{vec4(0, -2, 0, 5), vec4(3, 0, 0, 6), vec4(0, 0, -1, 7)}};    // and mirrored
    const Transform sheared = {{vec4(1, 0.5f, 0, 5), vec4(0, 1, 0, 6), vec4(0, 0, 1, 7)}};  // no node has that
    for (const Transform& transform : {Transform::translation({4, 5, 6}), turned, sheared}) {
        const Scene scene = two_boxes(transform);
        write_glb(folder / "a.glb", scene, std::vector<Rgb>(24, red));
        expect_same_triangles(scene, load_scene(folder / "a.glb"));
        EXPECT_EQ(chunks_of(folder / "a.glb").json["nodes"][1].contains("matrix"), transform != sheared);
    }
}

// Positive where fronts are outward.
double enclosed_volume(const Scene& scene) {
    const Mesh mesh = joined(scene, "all");
    double volume = 0;
    for (const uvec3& t : mesh.triangles)
        volume += dot(dvec3(mesh.positions[t.x]), cross(dvec3(mesh.positions[t.y]), dvec3(mesh.positions[t.z]))) / 6;
    return volume;
}

TEST(Glb, FrontsOfMirroredInstancesStayFronts) {
    const TempDir folder;
    const Transform mirrored = {{vec4(-1, 0, 0, 5), vec4(0, 1, 0, 6), vec4(0, 0, 1, 7)}};
    const Transform sheared = {{vec4(-1, 0.5f, 0, 5), vec4(0, 1, 0, 6), vec4(0, 0, 1, 7)}};  // no node has that
    for (const Transform& transform : {mirrored, sheared}) {
        const Scene scene = two_boxes(transform);
        EXPECT_NEAR(enclosed_volume(scene), 12, 1e-4);
        write_glb(folder / "a.glb", scene, std::vector<Rgb>(24, red));
        EXPECT_NEAR(enclosed_volume(load_scene(folder / "a.glb")), 12, 1e-4);
    }
}

TEST(Glb, InstancesShareAMeshWhereTheirColorsAreTheSame) {
    const TempDir folder;
    const Scene scene = two_boxes(Transform::translation({4, 5, 6}));
    std::vector<Rgb> colors(24, red);
    write_glb(folder / "a.glb", scene, colors);
    EXPECT_EQ(chunks_of(folder / "a.glb").json["meshes"].size(), 1u);
    EXPECT_EQ(chunks_of(folder / "a.glb").json["nodes"].size(), 2u);
    colors[23] = grey;
    write_glb(folder / "b.glb", scene, colors);
    EXPECT_EQ(chunks_of(folder / "b.glb").json["meshes"].size(), 2u);
    expect_same_triangles(scene, load_scene(folder / "b.glb"));
}

TEST(Glb, ColorsAreLinearAndOfFaces) {
    const TempDir folder;
    Scene scene = two_boxes({});
    scene.instances.pop_back();
    std::vector<Rgb> colors(12, red);
    colors[1] = grey;
    write_glb(folder / "a.glb", scene, colors);
    const Chunks file = chunks_of(folder / "a.glb");
    const nlohmann::json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    const nlohmann::json& accessor = file.json["accessors"][attributes["COLOR_0"].get<std::size_t>()];
    EXPECT_TRUE(accessor["normalized"].get<bool>());
    EXPECT_EQ(accessor["type"], "VEC4");
    EXPECT_EQ(accessor["count"], 36);
    const std::size_t start = file.json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"];
    for (std::size_t corner = 0; corner < 36; ++corner) {
        std::array<std::uint16_t, 4> color{};
        std::memcpy(color.data(), &file.binary[start + 8 * corner], 8);
        const bool is_grey = corner / 3 == 1;
        EXPECT_NEAR(color[0] / 65535.0, is_grey ? 0.5 : 1, 0.005) << corner;  // sRGB 188 is half of the light
        EXPECT_NEAR(color[1] / 65535.0, is_grey ? 0.5 : 0, 0.005) << corner;
        EXPECT_EQ(color[3], 65535);
    }
}

TEST(Glb, LeavesOutWhatGltfDoesNotAllow) {
    const TempDir folder;
    Scene scene = two_boxes({});
    scene.meshes[0].positions[scene.meshes[0].triangles[0].x].y = NAN;
    write_glb(folder / "a.glb", scene, std::vector<Rgb>(24));
    const std::size_t left = count_triangles(load_scene(folder / "a.glb"));
    EXPECT_TRUE(left > 0 && left < 24) << left;
    write_glb(folder / "empty.glb", {}, {});
    expect_error("holds no triangles", [&] { load_scene(folder / "empty.glb"); });
    expect_error("3 colours for 24 faces", [&] { write_glb(folder / "a.glb", scene, std::vector<Rgb>(3)); });
}

}  // namespace
}  // namespace twinray::test
