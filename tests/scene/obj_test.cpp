// SPDX-License-Identifier: MIT
#include <cmath>

#include <twinray/scene.h>

#include "tests/scene/packed_bytes.h"
#include "tests/scene/load_text.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::test {
namespace {

const std::string CORNERS = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string OBJ_SQUARE = CORNERS + "f 1 2 3 4\n";

Scene load_obj(const std::string& content, const std::string& name = "a.obj") { return load_text(content, name); }

void expect_obj_error(const std::string& content, const std::string& part) {
    expect_load_error(content, "a.obj", part);
}

void expect_warnings(const Scene& scene, const std::vector<std::string>& parts) {
    ASSERT_EQ(scene.warnings.size(), parts.size()) << joined(scene.warnings);
    for (std::size_t i = 0; i < parts.size(); ++i) expect_contains(scene.warnings[i], parts[i]);
}

// Both triangles of the unit square, in one mesh of four vertices.
void expect_obj_square(const std::string& content) {
    SCOPED_TRACE(content);
    const Scene scene = load_obj(content);
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Obj, EqualVerticesAreOneAndOthersStayApart) {
    expect_obj_square("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n");
    const Scene scene = load_obj("v 0 0 0\nv 1e-6 0 0\nv 0 1e-6 0\nv 1e-6 1e-6 0\nf 1 2 3\nf 2 4 3\n");
    EXPECT_EQ(scene.meshes[0].positions.size(), 4u);
    EXPECT_EQ(scene.meshes[0].name, "a");
    EXPECT_EQ(scene.instances[0].transform, Transform());
}

TEST(Obj, NumbersAreRoundedOnceToDoubleAndThenToFloat) {
    const Scene scene = load_obj("v 0.1 16777217 5400000.26\nv 1e60 -1.#INF 1e-60\nv +1.0E+00 .5 -3.\nf 1 2 3\n");
    EXPECT_EQ(scene.meshes[0].positions[0], vec3(0.1f, 16777216, 5400000.5f));
    EXPECT_EQ(scene.meshes[0].positions[1], vec3(INFINITY, -INFINITY, 0));
    EXPECT_EQ(scene.meshes[0].positions[2], vec3(1, 0.5f, -3));
}

TEST(Obj, BlanksAndLineEndsAreFree) {
    expect_obj_square(OBJ_SQUARE);
    expect_obj_square(replaced(OBJ_SQUARE, "\n", "\r\n"));
    expect_obj_square(replaced(OBJ_SQUARE, "\n", "\r"));
    expect_obj_square(replaced(OBJ_SQUARE, " ", "\t"));
    expect_obj_square(replaced("  " + replaced(OBJ_SQUARE, " ", "   "), "\n", "  \n\n \t "));
    expect_obj_square("\xef\xbb\xbf" + OBJ_SQUARE);
    expect_obj_square(OBJ_SQUARE.substr(0, OBJ_SQUARE.size() - 1));
}

TEST(Obj, ABackslashJoinsLinesAndACommentEndsThem) {
    expect_obj_square(CORNERS + "f 1 2 \\\n3 4\n");
    expect_obj_square(CORNERS + "f 1\\\r\n 2 \\ \r\n3 4");
    expect_obj_square("# C:\\models\\\n" + CORNERS + "f 1 2 3 4 # the only one \\\n# end");
    expect_obj_square(CORNERS + "f 1 2 3 4#4 5\n");
    expect_obj_square(replaced(CORNERS, "\n", " # corner\n") + "f 1 2 3 4");
    expect_obj_square(CORNERS + "f 1 2 3 4 \\");
    expect_obj_square(CORNERS + "vn 1.#IND -1.#QNAN0 0 # \\\nf 1 2 3 4 \n");
    expect_obj_square(replaced(CORNERS, "1 0\n", "1 0.#a comment\n") + "f 1 2 3 4\n");
}

TEST(Obj, CornersAreWrittenInManyWays) {
    expect_obj_square(CORNERS + "f -4 -3 -2 -1\n");
    expect_obj_square(CORNERS + "f 1 -3 3 -1\n" + CORNERS);  // negative ones count from where they stand
    expect_obj_square("f 1 2 3 4\n" + CORNERS);
    expect_obj_square(CORNERS + "f 1// 2// 3/ 4\n");
    expect_obj_square(CORNERS + "fo 1 2 3 4\n");
    expect_obj_square(replaced(OBJ_SQUARE, " 0\n", " 0 1.0\n"));
}

TEST(Obj, FacesOfOtherThanThreeCorners) {
    const Scene scene = load_obj(CORNERS + "f 1 2\nf 3\nf 1 2 3 4\nf\nl 1 2 3\np 1\n");
    EXPECT_EQ(count_triangles(scene), 2u);
    expect_warnings(scene, {"skipped 2 points and lines", "skipped 3 faces of fewer than 3 vertices"});
    expect_warnings(load_obj(CORNERS + "\nf 1 3 2 4\n"),
                    {"1 faces cross themselves, so that their triangles overlap (the first: line 6)"});
}

TEST(Obj, ConcavePolygonsOfManyCornersAreCoveredOnce) {
    std::string vertices, face = "f";
    constexpr int teeth = 200;
    int count = 0;
    const auto corner = [&](int x, int y) {
        vertices += text("v ", x, ' ', y, ' ', y, '\n');
        face += text(' ', ++count);
    };
    for (int i = 0; i < teeth; ++i)
        corner(4 * i + 0, 3), corner(4 * i + 1, 1), corner(4 * i + 2, 1), corner(4 * i + 3, 3);
    corner(4 * teeth, 0), corner(0, 0);
    const Scene scene = load_obj(vertices + face);
    double area = 0;
    for (const uvec3& t : scene.meshes[0].triangles) {
        const std::vector<vec3>& p = scene.meshes[0].positions;
        const vec3 across = cross(p[t.y] - p[t.x], p[t.z] - p[t.x]);
        EXPECT_LE(across.z, 0);  // clockwise
        area -= across.z / 2;
    }
    double outline = 0;
    for (int i = 0; i < teeth; ++i) outline += 2 + 1 + 2 + (i + 1 < teeth ? 3 : 1.5);
    EXPECT_DOUBLE_EQ(area, outline);
    EXPECT_TRUE(scene.warnings.empty()) << joined(scene.warnings);
}

TEST(Obj, DegenerateTrianglesStayAndKeepTheirIndex) {
    const Mesh mesh = load_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2\nf 1 2 3\n").meshes[0];
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 0, 1}, {0, 1, 2}}));
}

TEST(Obj, TextureCoordinatesMayHaveOneNumberOrThree) {
    const Mesh mesh = load_obj(CORNERS + "vt 0.5\nvt 0.25 0.75 0\nf 1/1 2/2 3/2\n").meshes[0];
    EXPECT_EQ(mesh.uvs, (std::vector<vec2>{{0.5f, 1}, {0.25f, 0.25f}, {0.25f, 0.25f}}));  // v up there, down here
}

TEST(Obj, ANormalThatIsNoNumberIsNone) {
    const Scene scene =
        load_obj(CORNERS + "vn 0 0 1\nvn nan nan nan\nvn -1.#IND 0 0\nf 1//1 2//2 3//3\nf 1//1 3 4//-1\n");
    const Mesh& mesh = scene.meshes[0];
    expect_warnings(scene, {"mesh 'a': 3 of 4 normals are 0, NaN or infinite; triangles show their own there"});
    EXPECT_EQ(mesh.normals, (std::vector<vec3>{{0, 0, 1}, vec3(0), vec3(0), vec3(0)}));
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Obj, WhatIsNotThereIsToldAndTheShapeLoads) {
    const Scene scene = load_obj(CORNERS + "vt 0 0\nf 1/1/1 2/2/1 3/3/1\n");
    EXPECT_TRUE(scene.meshes[0].normals.empty());
    expect_warnings(scene,
                    {"faces use what the file does not have: 'normals' (line 6), 'texture coordinates' (line 6)"});
}

TEST(Obj, WordsWithoutUseAreToldOnceWithTheirFirstLines) {
    const Scene scene = load_obj("vp 0.3 0.4\ncstype bspline\n" + OBJ_SQUARE + "s off\nshadow_obj x\nvp 1 2\nend\n");
    EXPECT_EQ(count_triangles(scene), 2u);
    expect_warnings(
        scene,
        {"passed over lines that begin with 'vp' (line 1), 'cstype' (line 2), 'shadow_obj' (line 9), 'end' (line 11)"});
    std::string many;
    for (int i = 0; i < 20; ++i) many += text("word", i, " x\n");
    expect_warnings(load_obj(many + OBJ_SQUARE), {"'word7' (line 8) and 12 more"});
    expect_warnings(load_obj(replaced(OBJ_SQUARE, " 0\n", " 0 1 0.5 0\n")), {"vertex colours are ignored"});
    expect_warnings(load_obj(replaced(OBJ_SQUARE, " 0\n", " 0 2\n")), {"weights of vertices"});
}

TEST(Obj, AMeshIsAnObjectOrElseAGroup) {
    const std::string faces[] = {"f 1 2 3\n", "f 1 3 4\n"};
    const auto names = [](const Scene& scene) {
        std::vector<std::string> all;
        for (const Mesh& mesh : scene.meshes) all.push_back(mesh.name);
        return joined(all);
    };
    EXPECT_EQ(names(load_obj(CORNERS + "o\ng\n" + faces[0] + "g front side\n" + faces[1] + "g back\n")),
              "a, front side");
    EXPECT_EQ(names(load_obj(CORNERS + "o cube\ng front\n" + faces[0] + "g back\n" + faces[1])), "cube");
    EXPECT_EQ(names(load_obj(CORNERS + "o one\n" + faces[0] + "o two words # so\n" + faces[1])), "one, two words");
    const Scene again = load_obj(CORNERS + "g one\n" + faces[0] + "g two\n" + faces[1] + "g one\n" + faces[0]);
    EXPECT_EQ(names(again), "one, two");
    EXPECT_EQ(again.meshes[0].triangles.size(), 2u);
}

TEST(Obj, GzipIsUnpacked) {
    EXPECT_EQ(count_triangles(load_obj(gzip_bytes(OBJ_SQUARE), "a.obj.gz")), 2u);
    const std::string packed = gzip_bytes(OBJ_SQUARE);
    const auto error = [](const std::string& bytes) { return error_of([&] { load_obj(bytes, "a.obj.gz"); }); };
    expect_contains(error(packed.substr(0, packed.size() - 9)), "gzip data is truncated");
    expect_contains(error(OBJ_SQUARE), "a.obj.gz': not valid gzip data");
    expect_contains(error(""), "gzip data is truncated");
}

TEST(Obj, FaultsAreNamedWithTheirLines) {
    expect_obj_error(CORNERS + "f 1 2 5\n", "line 5: vertex index 5 is out of range; there are 4 vertices");
    expect_obj_error(CORNERS + "f 1 2 -5\n", "line 5: '-5' has index -5, but there are 4 so far");
    expect_obj_error(CORNERS + "f 1 2 0\n", "line 5: '0' has index 0");
    expect_obj_error(CORNERS + "f 1 2 3.5\n", "line 5: '3.5' is not a vertex");
    expect_obj_error(CORNERS + "f 1 2 /3\n", "line 5: '/3' is not a vertex");
    expect_obj_error(CORNERS + "f 1 2 3/1/1/1\n", "line 5: '3/1/1/1' is not a vertex");
    expect_obj_error(CORNERS + "f 1 2 99999999999999999999\n", "is not a vertex");
    expect_obj_error(CORNERS + "f 1 2 4294967296\n", "has index 4294967296");
    expect_obj_error("\n# x\nv 0 \\\n0\n", "line 3: 'v' has 2 numbers; it needs 3");
    expect_obj_error("v 0 zero 0\n", "line 1: 'zero' is not a number");
    expect_obj_error("v 0 1,5 0\n", "line 1: '1,5' is not a number");
    expect_obj_error(std::string("v 0 0\0 0\n", 9), "not a text file");
    expect_obj_error("v 0 0 0\nv 1 0 0\nl 1 2\n", "holds no triangles to place (skipped 1 points and lines)");
    expect_obj_error("", "no triangles");
}

TEST(Obj, NonFiniteVerticesStayAndAreCounted) {
    const Scene scene = load_obj("v 0 0 0\nv 1 0 inf\nv 0 1 0\nv 1 1 1\nf 1 2 3\nf 1 3 4\nf 1 2 3 4\n");
    EXPECT_EQ(count_triangles(scene), 4u);
    expect_warnings(scene, {"2 of 4 triangles have a NaN or infinite coordinate"});
}

}  // namespace
}  // namespace twinray::test
