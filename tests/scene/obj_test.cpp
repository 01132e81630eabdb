// Files of type .obj: shapes, and the materials of their .mtl files.
#include "tests/scene/load_text.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::test {
namespace {

const std::string OBJ_CORNERS = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string OBJ_SQUARE = OBJ_CORNERS + "f 1 2 3 4\n";

Scene load_obj(const std::string& content, const std::string& name = "a.obj") { return load_text(content, name); }

void expect_obj_error(const std::string& content, const std::string& part) {
    expect_load_error(content, "a.obj", part);
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
    expect_obj_square(OBJ_CORNERS + "f 1 2 \\\n3 4\n");
    expect_obj_square(OBJ_CORNERS + "f 1\\\r\n 2 \\ \r\n3 4");
    expect_obj_square("# C:\\models\\\n" + OBJ_CORNERS + "f 1 2 3 4 # the only one \\\n# end");
    expect_obj_square(OBJ_CORNERS + "f 1 2 3 4#4 5\n");
    expect_obj_square(replaced(OBJ_CORNERS, "\n", " # corner\n") + "f 1 2 3 4");
    expect_obj_square(OBJ_CORNERS + "f 1 2 3 4 \\");
    expect_obj_square(OBJ_CORNERS + "vn 1.#IND -1.#QNAN0 0 # \\\nf 1 2 3 4 \n");
    expect_obj_square(replaced(OBJ_CORNERS, "1 0\n", "1 0.#a comment\n") + "f 1 2 3 4\n");
}

TEST(Obj, CornersAreWrittenInManyWays) {
    expect_obj_square(OBJ_CORNERS + "f -4 -3 -2 -1\n");
    expect_obj_square(OBJ_CORNERS + "f 1 -3 3 -1\n" + OBJ_CORNERS);  // negative ones count from where they stand
    expect_obj_square("f 1 2 3 4\n" + OBJ_CORNERS);
    expect_obj_square(OBJ_CORNERS + "f 1// 2// 3/ 4\n");
    expect_obj_square(OBJ_CORNERS + "fo 1 2 3 4\n");
    expect_obj_square(replaced(OBJ_SQUARE, " 0\n", " 0 1.0\n"));
}

TEST(Obj, FacesOfOtherThanThreeCorners) {
    const Scene scene = load_obj(OBJ_CORNERS + "f 1 2\nf 3\nf 1 2 3 4\nf\nl 1 2 3\np 1\n");
    EXPECT_EQ(count_triangles(scene), 2u);
    expect_warnings(scene, {"skipped 2 points and lines", "skipped 3 faces of fewer than 3 vertices"});
    expect_warnings(load_obj(OBJ_CORNERS + "\nf 1 3 2 4\n"),
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
    const Mesh mesh = load_obj(OBJ_CORNERS + "vt 0.5\nvt 0.25 0.75 0\nf 1/1 2/2 3/2\n").meshes[0];
    EXPECT_EQ(mesh.uvs, (std::vector<vec2>{{0.5f, 1}, {0.25f, 0.25f}, {0.25f, 0.25f}}));  // v up there, down here
}

TEST(Obj, ANormalThatIsNoNumberIsNone) {
    const Scene scene =
        load_obj(OBJ_CORNERS + "vn 0 0 1\nvn nan nan nan\nvn -1.#IND 0 0\nf 1//1 2//2 3//3\nf 1//1 3 4//-1\n");
    const Mesh& mesh = scene.meshes[0];
    expect_warnings(scene, {"mesh 'a': 3 of 4 normals are 0, NaN or infinite; triangles show their own there"});
    EXPECT_EQ(mesh.normals, (std::vector<vec3>{{0, 0, 1}, vec3(0), vec3(0), vec3(0)}));
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Obj, WhatIsNotThereIsToldAndTheShapeLoads) {
    const Scene scene = load_obj(OBJ_CORNERS + "vt 0 0\nf 1/1/1 2/2/1 3/3/1\n");
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
    EXPECT_EQ(names(load_obj(OBJ_CORNERS + "o\ng\n" + faces[0] + "g front side\n" + faces[1] + "g back\n")),
              "a, front side");
    EXPECT_EQ(names(load_obj(OBJ_CORNERS + "o cube\ng front\n" + faces[0] + "g back\n" + faces[1])), "cube");
    EXPECT_EQ(names(load_obj(OBJ_CORNERS + "o one\n" + faces[0] + "o two words # so\n" + faces[1])), "one, two words");
    const Scene again = load_obj(OBJ_CORNERS + "g one\n" + faces[0] + "g two\n" + faces[1] + "g one\n" + faces[0]);
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
    expect_obj_error(OBJ_CORNERS + "f 1 2 5\n", "line 5: vertex index 5 is out of range; there are 4 vertices");
    expect_obj_error(OBJ_CORNERS + "f 1 2 -5\n", "line 5: '-5' has index -5, but there are 4 so far");
    expect_obj_error(OBJ_CORNERS + "f 1 2 0\n", "line 5: '0' has index 0");
    expect_obj_error(OBJ_CORNERS + "f 1 2 3.5\n", "line 5: '3.5' is not a vertex");
    expect_obj_error(OBJ_CORNERS + "f 1 2 /3\n", "line 5: '/3' is not a vertex");
    expect_obj_error(OBJ_CORNERS + "f 1 2 3/1/1/1\n", "line 5: '3/1/1/1' is not a vertex");
    expect_obj_error(OBJ_CORNERS + "f 1 2 99999999999999999999\n", "is not a vertex");
    expect_obj_error(OBJ_CORNERS + "f 1 2 4294967296\n", "has index 4294967296");
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

const std::string TRIANGLE_WITH_UVS = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";

// Loads a triangle of material "a" of a file a.mtl.
Scene load_with_mtl(const std::string& mtl, const std::string& used = "a") {
    const TempDir dir;
    dir.write("a.mtl", mtl);
    dir.write("skin.png", png_bytes(1, 1, 8, 6, "abcd"));
    return load_scene(
        dir.write("a.obj", "mtllib a.mtl\n" + TRIANGLE_WITH_UVS + "usemtl " + used + "\nf 1/1 2/2 3/3\n"));
}

const Material& used_in(const Scene& scene) { return scene.materials[scene.meshes[0].material(0)]; }

vec3 color_of(const std::string& mtl, const std::string& used = "a") {
    return vec3(used_in(load_with_mtl(mtl, used)).base_color);
}

TEST(Mtl, ColoursOpacityAndTexture) {
    const Scene scene = load_with_mtl("newmtl a\nKd 0.5 0.25 0\nKe 1 2 3\nd 0.5\nmap_Kd skin.png\nNs 10\nillum 2\n");
    const Material& material = used_in(scene);
    EXPECT_EQ(material.name, "a");
    EXPECT_EQ(material.base_color, vec4(0.5f, 0.25f, 0, 0.5f));
    EXPECT_EQ(material.emission, vec3(1, 2, 3));
    EXPECT_EQ(material.roughness, 1);
    EXPECT_EQ(material.metallic, 0);
    EXPECT_EQ(material.alpha_mode, AlphaMode::blend);
    EXPECT_EQ(scene.images[std::size_t(material.base_color_texture.image)].rgba[0], 'a');
    EXPECT_TRUE(scene.warnings.empty()) << joined(scene.warnings);
}

TEST(Mtl, LinesAreAsFreeAsInObjFiles) {
    const vec3 orange(0.75f, 0.5f, 0.25f);
    EXPECT_EQ(color_of("\xef\xbb\xbf# paint\r\n\r\n  newmtl a  \r\n\tKd 0.75 0.5 0.25 # orange"), orange);
    EXPECT_EQ(color_of("newmtl red\nKd 1 0 0\nnewmtl red paint\nKd 0.75 0.5 0.25\n", "red paint"), orange);
    EXPECT_EQ(color_of("newmtl Material #25\nKd 0.75 0.5 0.25\nnewmtl Material #26\nKd 0 0 0\n", "Material #25"),
              orange);
    EXPECT_EQ(color_of("newmtl a # paint\nKd 0.5\nKd 0.75 0.5\\\n 0.25\n", "a # so"), orange);
    EXPECT_EQ(color_of("newmtl a\nKd 0.5\n"), vec3(0.5f));
}

TEST(Mtl, TrIsTheOppositeOfDWhichCounts) {
    const auto opacity = [](const std::string& lines) {
        return used_in(load_with_mtl("newmtl a\n" + lines)).base_color.w;
    };
    EXPECT_EQ(opacity("Tr 0.75\n"), 0.25f);
    EXPECT_EQ(opacity("d 1\nTr 1\n"), 1);
    EXPECT_EQ(opacity("Tr 1\nd 1\n"), 1);
    EXPECT_EQ(opacity("d -halo 0.25\n"), 0.25f);
    EXPECT_EQ(opacity("d 2\n"), 1);
    EXPECT_EQ(used_in(load_with_mtl("newmtl a\nd 0.5\nd 1\n")).alpha_mode, AlphaMode::opaque);
}

TEST(Mtl, WithoutAColourItIsGreyOrTheTexture) {
    EXPECT_EQ(color_of("newmtl a\n"), vec3(0.6f));
    EXPECT_EQ(color_of("newmtl a\nmap_Kd skin.png\n"), vec3(1));
    EXPECT_EQ(color_of("newmtl a\nmap_Kd skin.png\nKd 0.5\n"), vec3(0.5f));
}

TEST(Mtl, OptionsOfATextureAreReadOrPassedOver) {
    const Scene scene = load_with_mtl("newmtl a\nmap_Kd -s 2 4 1 -o 0.5 0.25 -clamp on -mm 0 1 -blendu off skin.png\n");
    const Texture& texture = used_in(scene).base_color_texture;
    EXPECT_EQ(texture.uv_row0, vec3(2, 0, 0.5f));
    EXPECT_EQ(texture.uv_row1, vec3(0, 4, 1 - 4 - 0.25f));  // v up in the file: 4 v + 0.25
    EXPECT_EQ(texture.wrap_u, Wrap::clamp_to_edge);
    expect_warnings(scene, {"a.mtl': passed over '-blendu' (line 2), '-mm' (line 2)"});
}

TEST(Mtl, TexturesAreFoundBesideEitherFile) {
    const TempDir dir;
    std::filesystem::create_directory(dir / "paint");
    dir.write("paint/1 red.png", png_bytes(1, 1, 8, 6, "rgba"));
    dir.write("blue.png", png_bytes(1, 1, 8, 6, "bgra"));
    dir.write("paint/a.mtl",
              "newmtl a\nmap_Kd -s 1 1 1 1 red.png\nnewmtl b\nmap_Kd .\\blue.png\nnewmtl c\nmap_Kd paint\\1 red.png\n");
    const Scene scene =
        load_scene(dir.write("a.obj", "mtllib .\\paint\\a.mtl\nmtllib .\\paint\\a.mtl\n" + TRIANGLE_WITH_UVS +
                                          "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n"));
    EXPECT_TRUE(scene.warnings.empty()) << joined(scene.warnings);
    ASSERT_EQ(scene.materials.size(), 3u);
    const auto first_byte = [&](std::size_t i) {
        return scene.images[std::size_t(scene.materials[i].base_color_texture.image)].rgba[0];
    };
    EXPECT_EQ(first_byte(0), 'r');
    EXPECT_EQ(first_byte(1), 'b');
    EXPECT_EQ(first_byte(2), 'r');
}

TEST(Mtl, SeveralFilesAndBlanksInNames) {
    const TempDir dir;
    dir.write("my paint.mtl", "newmtl a\nKd 0.5\n");
    dir.write("b.MTL", "newmtl b\nKd 0.25\nnewmtl a\nKd 0.125\n");
    const Scene scene =
        load_scene(dir.write("a.obj", "mtllib my paint.mtl b.MTL # both\n" + TRIANGLE_WITH_UVS + "f 1 2 3\n"));
    EXPECT_TRUE(scene.warnings.empty()) << joined(scene.warnings);
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(scene.materials[0].base_color.x, 0.125f);  // set again
    EXPECT_EQ(scene.materials[1].base_color.x, 0.25f);
    EXPECT_EQ(scene.materials[2].name, "default");
    EXPECT_EQ(scene.meshes[0].materials, std::vector<uint>{2});
}

// Materials are as in a glTF file: in the order of the file, used or not, and with nothing before them.
TEST(Mtl, MaterialsKeepTheirOrderAndCutNoMesh) {
    const TempDir dir;
    dir.write("a.mtl", "newmtl a\nnewmtl b\nnewmtl unused\nnewmtl c\n");
    const Scene scene = load_scene(dir.write("a.obj", "mtllib a.mtl\no body\n" + TRIANGLE_WITH_UVS +
                                                          "usemtl c\nf 1 2 3\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n"));
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].positions.size(), 3u);
    EXPECT_EQ(scene.meshes[0].materials, (std::vector<uint>{3, 0, 1}));
    EXPECT_EQ(scene.materials.size(), 4u);
}

TEST(Mtl, WhatIsMissingIsNamed) {
    const TempDir dir;
    const Scene scene = load_scene(
        dir.write("a.obj", "mtllib nowhere.mtl\n" + TRIANGLE_WITH_UVS + "usemtl b\nf 1 2 3\nusemtl a\nf 1 2 3\n"));
    EXPECT_EQ(scene.meshes[0].materials, (std::vector<uint>{0, 1}));
    EXPECT_EQ(scene.materials[0].name, "b");
    EXPECT_EQ(scene.materials[0].base_color, vec4(0.6f, 0.6f, 0.6f, 1));
    expect_warnings(scene, {"nowhere.mtl': file not found; its materials are missing",
                            "no .mtl file of it has are shown grey: 'b' (line 8), 'a' (line 10)"});
}

TEST(Mtl, AMissingImageIsACheckerboard) {
    const Scene scene = load_with_mtl("newmtl a\nmap_Kd sub\\no.png\n");
    EXPECT_EQ(scene.images[std::size_t(used_in(scene).base_color_texture.image)].width, 32u);
    expect_warnings(scene, {"sub/no.png': file not found; it is shown as a checkerboard"});
}

TEST(Mtl, WhatHasNoUseIsToldOnce) {
    const Scene scene = load_with_mtl(
        "Kd 1 1 1\nnewmtl a\nKd spectral file.rfl\nd\nmap_Bump b.png\nmap_Bump c.png\nmap_Kd\nKe nan 0 0\n");
    EXPECT_EQ(used_in(scene).base_color, vec4(0.6f, 0.6f, 0.6f, 1));
    expect_warnings(
        scene,
        {"passed over 'Kd' (line 1), 'Kd spectral' (line 3), 'd ' (line 4), 'map_Bump' (line 5), 'map_Kd' (line 7), "
         "'Ke nan' (line 8)"});
}

}  // namespace
}  // namespace twinray::test
