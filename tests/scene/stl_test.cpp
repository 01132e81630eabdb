// SPDX-License-Identifier: MIT
#include <cmath>

#include <twinray/scene.h>

#include "tests/scene/packed_bytes.h"
#include "tests/scene/load_text.h"

namespace twinray::test {
namespace {

const std::string STL_SQUARE =
    "solid s\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\n"
    "endsolid s\n";

// Returns the same square; the count may be a lie.
std::string binary_square(const std::string& header = "made by a test", std::uint32_t count = 2, float normal = 1) {
    std::string file = header;
    file.resize(80, ' ');
    const auto put = [&](auto value) { file.append(reinterpret_cast<const char*>(&value), sizeof value); };
    put(count);
    for (const auto& corners : {std::array<vec3, 3>{vec3(0, 0, 0), vec3(1, 0, 0), vec3(1, 1, 0)},
                                std::array<vec3, 3>{vec3(0, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)}}) {
        put(vec3(normal));
        put(corners);
        put(std::uint16_t{0x8421});
    }
    return file;
}

Scene load_stl(const std::string& content, const std::string& name = "a.stl") { return load_text(content, name); }

void expect_stl_error(const std::string& content, const std::string& part) {
    expect_load_error(content, "a.stl", part);
}

void expect_stl_square(const std::string& content, const std::string& name = "a.stl") {
    const Scene scene = load_stl(content, name);
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_TRUE(scene.meshes[0].normals.empty());
    EXPECT_TRUE(scene.warnings.empty()) << joined(scene.warnings);
}

TEST(Stl, TextAndBinaryAreToldApartByTheCount) {
    expect_stl_square(STL_SQUARE);
    expect_stl_square(binary_square());
    expect_stl_square(binary_square("solid part_7 exported by a CAD program"));
    expect_stl_square(binary_square(std::string("solid\0", 6)));
    expect_stl_square(gzip_bytes(STL_SQUARE), "a.stl.gz");
    expect_stl_square(gzip_bytes(binary_square()), "a.STL.gz");
}

TEST(Stl, FacetNormalsAreNotRead) {
    expect_stl_square(binary_square("x", 2, NAN));
    for (const char* normal : {"nan nan nan", "-nan 0 0", "-1.#IND -1.#IND -1.#IND", "1.#QNAN 0 0", "inf 0 0", "", "?"})
        expect_stl_square(replaced(STL_SQUARE, "0 0 1\n", std::string(normal) + "\n"));
}

TEST(Stl, LinesAreFree) {
    expect_stl_square("\xef\xbb\xbf \n" + replaced(STL_SQUARE, "\n", "  \r\n\t "));
    expect_stl_square(replaced(STL_SQUARE, "\n", "\r"));
    expect_stl_square(replaced(replaced(STL_SQUARE, "solid", "SOLID"), "vertex", "VERTEX"));
    expect_stl_square(replaced(STL_SQUARE, "endsolid", "end solid"));
    expect_stl_square(STL_SQUARE.substr(0, STL_SQUARE.find("endsolid")));
    expect_stl_square(replaced(STL_SQUARE, " 1 ", " +1.0E+000 "));
    expect_stl_square(replaced(STL_SQUARE, "solid s", "solid assembly - 300K_can-1 facet"));
}

TEST(Stl, BytesAfterTheLastTriangleAreTold) {
    for (const std::size_t tail : {1, 2, 10, 512}) {
        const Scene scene = load_stl(binary_square("solid x") + std::string(tail, '\n'));
        EXPECT_EQ(count_triangles(scene), 2u);
        expect_warnings(scene, {text("ignored ", tail, " bytes after the last triangle")});
    }
}

TEST(Stl, EachSolidIsAMeshOfItsName) {
    const Scene scene = load_stl(STL_SQUARE + replaced(STL_SQUARE, "solid s", "solid two words") +
                                 "solid empty\nendsolid\n" + replaced(STL_SQUARE, "solid s", "solid"));
    ASSERT_EQ(scene.meshes.size(), 3u);
    EXPECT_EQ(scene.meshes[0].name, "s");
    EXPECT_EQ(scene.meshes[1].name, "two words");
    EXPECT_EQ(scene.instances[2].name, "a");  // the file's name
    EXPECT_EQ(load_stl(binary_square()).meshes[0].name, "a");
}

TEST(Stl, OtherFacetsThanTrianglesAndOtherWords) {
    const Scene scene = load_stl(
        "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 2 1 0\nvertex 0 1 "
        "0\nendloop\nendfacet\n"
        "facet\ncolor 1 0 0\nvertex 0 0 0\nvertex 2 0 0\n");
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}}));
    expect_warnings(
        scene, {"skipped 1 faces of fewer than 3 vertices", "passed over lines that begin with 'color' (line 11)"});
}

TEST(Stl, FaultsAreNamed) {
    expect_stl_error("", "not an STL file");
    expect_stl_error("facet normal 0 0 1\n", "not an STL file");
    expect_stl_error(std::string(100, 'x'), "not an STL file");
    expect_stl_error("solid s\nendsolid s\n", "holds no triangles to place");
    expect_stl_error(binary_square("x", 0), "holds no triangles to place (ignored 100 bytes after the last triangle)");
    expect_stl_error(binary_square("x", 3), "it says that it holds 3 triangles, but ends after 2");
    expect_stl_error(binary_square("solid", ~0u), "it says that it holds 4294967295 triangles, but ends after 2");
    expect_stl_error(replaced(STL_SQUARE, "vertex 1 0 0", "vertex 1 O 0"), "line 5: 'O' is not a number");
    expect_stl_error(replaced(STL_SQUARE, "vertex 1 0 0", "vertex 1 0"), "line 5: '' is not a number");
}

TEST(Stl, NonFiniteVerticesStayAndAreCounted) {
    const Scene scene = load_stl(replaced(STL_SQUARE, "vertex 1 0 0", "vertex -1.#IND 0 0"));
    EXPECT_EQ(count_triangles(scene), 2u);
    expect_warnings(scene, {"1 of 2 triangles have a NaN or infinite coordinate"});
}

}  // namespace
}  // namespace twinray::test
