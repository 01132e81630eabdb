// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/scene/polygon.h"
#include "engine/scene/scene.h"
#include "tests/scene/packed_bytes.h"
#include "tests/scene/temp_dir.h"

namespace twinray::test {
namespace {

const std::string POSITIONS = "property float x\nproperty float y\nproperty float z\n";
const std::string FACE_LIST = "property list uchar int vertex_indices\n";
const std::string TRIANGLE = "0 0 0\n1 0 0\n0 1 0\n";

// An ASCII file of those vertices and faces.
std::string ply(int vertex_count, const std::string& vertices, int face_count, const std::string& faces) {
    return text("ply\nformat ascii 1.0\ncomment made by a test\nelement vertex ", vertex_count, "\n", POSITIONS,
                "element face ", face_count, "\n", FACE_LIST, "end_header\n", vertices, faces);
}

Scene load(const std::string& content, const std::string& name = "a.ply") {
    const TempDir dir;
    return load_scene(dir.write(name, content));
}

void expect_error(const std::string& content, const std::string& part) {
    const std::string message = error_of([&] { load(content); });
    expect_contains(message, "a.ply");
    expect_contains(message, part);
}

TEST(Ply, AsciiKeepsVerticesTrianglesAndTheirOrder) {
    const Scene scene = load(ply(4, TRIANGLE + "0 0 0\n", 3, "3 0 1 2\n3 1 1 3\n3 3 2 1\n"));
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].name, "a");
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}));
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}, {1, 1, 3}, {3, 2, 1}}));
    EXPECT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.materials.size(), 1u);
}

TEST(Ply, NumbersAreRoundedOnceAndBeyondFloatAreInfiniteOrZero) {
    const Mesh mesh =
        load(ply(3, "0.1 1.00000005960464477539062500000001 +3\n1e60 -1e60 1e-60\nnan inf -inf\n", 1, "3 0 1 2\n"))
            .meshes[0];
    EXPECT_EQ(mesh.positions[0], vec3(0.1f, 1.00000012f, 3));
    EXPECT_EQ(mesh.positions[1], vec3(INFINITY, -INFINITY, 0));
    EXPECT_TRUE(std::isnan(mesh.positions[2].x));
    EXPECT_EQ(mesh.positions[2].z, -INFINITY);
}

// A binary triangle with double positions, an unknown list before the indices and 32-bit list lengths.
std::string binary_ply(bool is_big_endian) {
    std::string file =
        text("ply\r\nformat binary_", is_big_endian ? "big" : "little",
             "_endian 1.0\r\nelement vertex 3\r\nproperty double x\r\nproperty uchar red\r\n"
             "property double y\r\nproperty double z\r\nelement face 1\r\n"
             "property list ushort short flags\r\nproperty list int uint vertex_index\r\nend_header\r\n");
    const auto put = [&](auto value) {
        std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
        if (is_big_endian) std::reverse(bytes.begin(), bytes.end());
        file += bytes;
    };
    for (int i = 0; i < 3; ++i) {
        put(double(i == 1));
        put(std::uint8_t(7));
        put(double(i == 2));
        put(-0.25);
    }
    put(std::uint16_t(2)), put(std::int16_t(-5)), put(std::int16_t(-6));
    put(std::int32_t(3)), put(std::uint32_t(2)), put(std::uint32_t(1)), put(std::uint32_t(0));
    return file;
}

TEST(Ply, BothEndiansAndUnknownPropertiesAreRead) {
    for (const bool is_big_endian : {false, true}) {
        const Mesh mesh = load(binary_ply(is_big_endian)).meshes[0];
        EXPECT_EQ(mesh.positions, (std::vector<vec3>{{0, 0, -0.25f}, {1, 0, -0.25f}, {0, 1, -0.25f}}));
        EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{2, 1, 0}}));
    }
}

TEST(Ply, NormalsAndTextureCoordinatesAreTakenFromAnyPlace) {
    const Mesh mesh = load(
                          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float s\nproperty float t\n"
                          "property float nx\nproperty float ny\nproperty float nz\n" +
                          POSITIONS + "element face 1\n" + FACE_LIST +
                          "end_header\n0.5 0.25 0 0 1 0 0 0\n0 0 0 0 1 1 0 0\n0 0 0 0 1 0 1 0\n3 0 1 2\n")
                          .meshes[0];
    EXPECT_EQ(mesh.positions[1], vec3(1, 0, 0));
    EXPECT_EQ(mesh.normals, std::vector<vec3>(3, vec3(0, 0, 1)));
    EXPECT_EQ(mesh.uvs[0], vec2(0.5f, 0.75f));  // v up in .ply, down here
}

TEST(Ply, AListIsNoTextureCoordinate) {
    const Mesh mesh = load("ply\nformat ascii 1.0\nelement vertex 3\n" + POSITIONS +
                           "property list uchar float u\nproperty float v\nelement face 1\n" + FACE_LIST +
                           "end_header\n0 0 0 0 9\n1 0 0 1 5 9\n0 1 0 2 5 6 9\n3 0 1 2\n")
                          .meshes[0];
    EXPECT_TRUE(mesh.uvs.empty());
    EXPECT_EQ(mesh.positions[2], vec3(0, 1, 0));
}

TEST(Ply, FacesMayComeBeforeVerticesAndOtherElementsAreSkipped) {
    const Mesh mesh = load("ply\nformat ascii 1.0\nelement face 1\n" + FACE_LIST +
                           "element edge 2\nproperty int a\nproperty list uchar int vertex_index\nelement vertex 3\n" +
                           POSITIONS + "end_header\n3 0 1 2\n5 2 6 7\n8 0\n" + TRIANGLE)
                          .meshes[0];
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}}));
    EXPECT_EQ(mesh.positions[2], vec3(0, 1, 0));
}

TEST(Ply, GzipIsUnpacked) {
    EXPECT_EQ(count_triangles(load(gzip_bytes(ply(3, TRIANGLE, 1, "3 0 1 2\n")), "a.PLY.GZ")), 1u);
}

TEST(Ply, FacesOfFewerThanThreeCornersAreSkippedWithACount) {
    const Scene scene = load(ply(3, TRIANGLE, 3, "2 0 1\n3 0 1 2\n0\n"));
    EXPECT_EQ(count_triangles(scene), 1u);
    ASSERT_EQ(scene.warnings.size(), 1u);
    expect_contains(scene.warnings[0], "skipped 2 faces");
}

TEST(Ply, ALineThatForgotToBeACommentIsReadOver) {
    EXPECT_EQ(count_triangles(
                  load("ply\nformat ascii 1.0\nCreated by Blender\n" + ply(3, TRIANGLE, 1, "3 0 1 2\n").substr(21))),
              1u);
}

TEST(Ply, HeaderFaultsAreNamed) {
    const std::string good = ply(3, TRIANGLE, 1, "3 0 1 2\n");
    const auto replaced = [&](const std::string& from, const std::string& to) {
        std::string bad = good;
        return bad.replace(bad.find(from), from.size(), to);
    };
    expect_error("", "does not start with 'ply'");
    expect_error("solid stl\n", "does not start with 'ply'");
    expect_error("ply\nformat ascii 1.0\nelement vertex 1\n", "no end_header");
    expect_error(replaced("ascii", "morse"), "line 2 'format morse 1.0' is not understood");
    expect_error(replaced("element face 1", "element face -1"), "line 8 'element face -1' is not understood");
    expect_error(replaced("property list", "propety list"), "is not understood");
    expect_error(replaced("uchar", "float"), "is not understood");
    expect_error(replaced("property float z", "property real z"), "line 7 'property real z' is not understood");
    expect_error(replaced("property float z\n", ""), "have no x, y and z");
    expect_error(replaced("vertex 3", "vertex 4000000000"), "4000000000 elements 'vertex' do not fit");
    expect_error(replaced("face 1", "face 999999999999"), "999999999999 elements 'face' do not fit");
}

TEST(Ply, BodyFaultsAreNamed) {
    expect_error(ply(3, TRIANGLE, 1, "3 0 1 3\n"), "face 0 has vertex index 3, but there are only 3 vertices");
    expect_error(ply(3, TRIANGLE, 2, "3 0 1 2\n3 0 1 -1\n"), "face 1 has vertex index -1");
    expect_error(ply(3, TRIANGLE, 1, "3 0 1 0.5\n"), "face 0 has vertex index 0.5");
    expect_error(ply(3, TRIANGLE, 1, "3 0 1\n"), "truncated");
    expect_error(ply(3, TRIANGLE, 1, "-3 0 1 2\n"), "list claims -3 entries");
    expect_error(ply(3, TRIANGLE, 1, "9999 0 1 2\n"), "list claims 9999 entries");
    expect_error(ply(3, "0 0 zero\n", 1, "3 0 1 2\n"), "'zero");
    expect_error(ply(3, "0 0 0x1\n", 1, "3 0 1 2\n"), "'0x1");
    expect_error(ply(3, TRIANGLE, 0, ""), "has 3 vertices but no faces");
    const std::string binary = binary_ply(false);
    expect_error(binary.substr(0, binary.size() - 1), "truncated");
}

double area_facing_z(const std::vector<vec3>& positions, const std::vector<uvec3>& triangles) {
    double area = 0;
    for (const uvec3& t : triangles) {
        const double part = cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x]).z / 2;
        EXPECT_GE(part, 0);
        area += part;
    }
    return area;
}

TEST(Polygon, ConcaveOnesAreCutInsideThemselves) {
    const std::vector<vec3> arrow = {{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}};
    const std::vector<uint> all = {0, 1, 2, 3};
    for (std::size_t first = 0; first < 4; ++first) {  // wherever the list starts
        std::vector<uint> corners = all;
        std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(first), corners.end());
        const auto triangles = triangulate_polygon(arrow, corners);
        EXPECT_EQ(triangles.size(), 2u);
        EXPECT_DOUBLE_EQ(area_facing_z(arrow, triangles), 1);
    }
    const auto reversed = triangulate_polygon(arrow, std::vector<uint>{3, 2, 1, 0});
    ASSERT_EQ(reversed.size(), 2u);
    for (const uvec3& t : reversed) EXPECT_LT(cross(arrow[t.y] - arrow[t.x], arrow[t.z] - arrow[t.x]).z, 0);
    const std::vector<vec3> star = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {3, 1, 0}, {0, 4, 0}, {1, 1, 0}};
    const auto triangles = triangulate_polygon(star, std::vector<uint>{0, 1, 2, 3, 4, 5});
    EXPECT_EQ(triangles.size(), 4u);
    EXPECT_DOUBLE_EQ(area_facing_z(star, triangles), 8);
}

TEST(Polygon, WindingIsKeptInEveryPlane) {
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {1.0f, -1.0f}) {
            std::vector<vec3> positions(4, vec3(0));
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            positions[1][u] = positions[2][u] = 1;
            positions[2][v] = positions[3][v] = side;
            for (const uvec3& t : triangulate_polygon(positions, std::vector<uint>{0, 1, 2, 3}))
                EXPECT_EQ(cross(positions[t.y] - positions[t.x], positions[t.z] - positions[t.x])[axis], side);
        }
}

TEST(Polygon, WhatHasNoEarIsCutAsAFan) {
    const std::vector<vec3> degenerate(5, vec3(1));
    EXPECT_EQ(triangulate_polygon(degenerate, std::vector<uint>{0, 1, 2, 3, 4}),
              (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
    const std::vector<vec3> broken(4, vec3(NAN));
    EXPECT_EQ(triangulate_polygon(broken, std::vector<uint>{0, 1, 2, 3}).size(), 2u);
}

TEST(Polygon, OnesOfVeryManyCornersAreCutAsAFan) {
    std::vector<vec3> circle;
    std::vector<uint> corners;
    for (uint i = 0; i < 300; ++i) {
        const float angle = static_cast<float>(i) * 0.02f;
        circle.emplace_back(std::cos(angle), std::sin(angle), 0);
        corners.push_back(i);
    }
    circle[1] = vec3(0);  // turns outwards, so that no ear would be cut there
    const auto triangles = triangulate_polygon(circle, corners);
    EXPECT_EQ(triangles.size(), 298u);
    EXPECT_EQ(triangles[0], uvec3(0, 1, 2));
}

}  // namespace
}  // namespace twinray::test
