#include "engine/scene/importers/ply_header.h"
#include "tests/scene/load_text.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::test {
namespace {

const std::string POSITIONS = "property float x\nproperty float y\nproperty float z\n";
const std::string FACE_LIST = "property list uchar int vertex_indices\n";
const std::string TRIANGLE_ROWS = "0 0 0\n1 0 0\n0 1 0\n";

// Returns an ASCII file of these vertices and faces.
std::string ply(int vertex_count, const std::string& vertices, int face_count, const std::string& faces) {
    return text("ply\nformat ascii 1.0\ncomment made by a test\nelement vertex ", vertex_count, "\n", POSITIONS,
                "element face ", face_count, "\n", FACE_LIST, "end_header\n", vertices, faces);
}

Scene load_ply(const std::string& content, const std::string& name = "a.ply") { return load_text(content, name); }

void expect_ply_error(const std::string& content, const std::string& part) {
    expect_load_error(content, "a.ply", part);
}

TEST(Ply, AsciiKeepsVerticesTrianglesAndTheirOrder) {
    const Scene scene = load_ply(ply(4, TRIANGLE_ROWS + "0 0 0\n", 3, "3 0 1 2\n3 1 1 3\n3 3 2 1\n"));
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].name, "a");
    EXPECT_EQ(scene.meshes[0].positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}}));
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}, {1, 1, 3}, {3, 2, 1}}));
    EXPECT_EQ(scene.instances.size(), 1u);
    EXPECT_EQ(scene.materials.size(), 1u);
}

TEST(Ply, NumbersAreAsTheirDigitsSayAndBeyondFloatInfiniteOrZero) {
    const Mesh mesh =
        load_ply(ply(4, "0.1 1.00000005960465 +3\n1e60 -1e999 1e-999\nnan inf -inf\n0 0 0\n", 2, "3 0 1 2\n3 0 1 3\n"))
            .meshes[0];
    EXPECT_EQ(mesh.positions[0], vec3(0.1f, 1.00000012f, 3));
    EXPECT_EQ(mesh.positions[1], vec3(INFINITY, -INFINITY, 0));
    EXPECT_TRUE(std::isnan(mesh.positions[2].x));
    EXPECT_EQ(mesh.positions[2].z, -INFINITY);
}

// Returns a binary triangle with double positions, an unknown list before the indices and 32-bit list lengths.
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
        const Mesh mesh = load_ply(binary_ply(is_big_endian)).meshes[0];
        EXPECT_EQ(mesh.positions, (std::vector<vec3>{{0, 0, -0.25f}, {1, 0, -0.25f}, {0, 1, -0.25f}}));
        EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{2, 1, 0}}));
    }
}

TEST(Ply, NormalsAndTextureCoordinatesAreTakenFromAnyPlace) {
    const Mesh mesh = load_ply(
                          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float s\nproperty float t\n"
                          "property float nx\nproperty float ny\nproperty float nz\n" +
                          POSITIONS + "element face 1\n" + FACE_LIST +
                          "end_header\n0.5 0.25 0 0 1 0 0 0\n0 0 0 0 1 1 0 0\n0 0 0 0 1 0 1 0\n3 0 1 2\n")
                          .meshes[0];
    EXPECT_EQ(mesh.positions[1], vec3(1, 0, 0));
    EXPECT_EQ(mesh.normals, std::vector<vec3>(3, vec3(0, 0, 1)));
    EXPECT_EQ(mesh.uvs[0], vec2(0.5f, 0.75f));  // v up in .ply, down here
}

TEST(Ply, NormalsWithoutADirectionAreCounted) {
    const Scene scene = load_ply("ply\nformat ascii 1.0\nelement vertex 3\n" + POSITIONS +
                                 "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n" +
                                 FACE_LIST + "end_header\n0 0 0 0 0 0\n1 0 0 nan 0 1\n0 1 0 0 0 2\n3 0 1 2\n");
    expect_warnings(scene, {"2 of 3 normals are 0, NaN or infinite; triangles show their own there"});
}

TEST(Ply, AListIsNoTextureCoordinate) {
    const Mesh mesh = load_ply("ply\nformat ascii 1.0\nelement vertex 3\n" + POSITIONS +
                               "property list uchar float u\nproperty float v\nelement face 1\n" + FACE_LIST +
                               "end_header\n0 0 0 0 9\n1 0 0 1 5 9\n0 1 0 2 5 6 9\n3 0 1 2\n")
                          .meshes[0];
    EXPECT_TRUE(mesh.uvs.empty());
    EXPECT_EQ(mesh.positions[2], vec3(0, 1, 0));
}

TEST(Ply, FacesMayComeBeforeVerticesAndOtherElementsAreSkipped) {
    const Scene scene = load_ply(
        "ply\nformat ascii 1.0\nelement face 1\nproperty uchar flags\n" + FACE_LIST +
        "element edge 2\nproperty int a\nproperty list uchar int vertex_index\nelement vertex 3\n" + POSITIONS +
        "property uchar red\nend_header\n0 3 0 1 2\n5 2 6 7\n8 0\n0 0 0 255\n1 0 0 255\n0 1 0 255\n");
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}}));
    EXPECT_EQ(scene.meshes[0].positions[2], vec3(0, 1, 0));
    expect_warnings(
        scene,
        {"passed over elements and properties of the header: 'flags' (line 4), 'edge' (line 6), 'colours' (line 13)"});
}

TEST(Ply, GzipIsUnpacked) {
    EXPECT_EQ(count_triangles(load_ply(gzip_bytes(ply(3, TRIANGLE_ROWS, 1, "3 0 1 2\n")), "a.PLY.GZ")), 1u);
}

TEST(Ply, FacesOfFewerThanThreeCornersAreSkippedWithACount) {
    const Scene scene = load_ply(ply(3, TRIANGLE_ROWS, 3, "2 0 1\n3 0 1 2\n0\n"));
    EXPECT_EQ(count_triangles(scene), 1u);
    expect_warnings(scene, {"skipped 2 faces"});
}

TEST(Ply, ALineThatForgotToBeACommentIsReadOver) {
    EXPECT_EQ(count_triangles(load_ply("ply\nformat ascii 1.0\nCreated by Blender\n" +
                                       ply(3, TRIANGLE_ROWS, 1, "3 0 1 2\n").substr(21))),
              1u);
}

TEST(Ply, HeaderFaultsAreNamed) {
    const std::string good = ply(3, TRIANGLE_ROWS, 1, "3 0 1 2\n");
    const auto replaced = [&](const std::string& from, const std::string& to) {
        std::string bad = good;
        return bad.replace(bad.find(from), from.size(), to);
    };
    expect_ply_error("", "does not start with 'ply'");
    expect_ply_error("solid stl\n", "does not start with 'ply'");
    expect_ply_error("ply\nformat ascii 1.0\nelement vertex 1\n", "no end_header");
    expect_ply_error(replaced("ascii", "morse"), "line 2 'format morse 1.0' is not understood");
    expect_ply_error(replaced("element face 1", "element face -1"), "line 8 'element face -1' is not understood");
    expect_ply_error(replaced("property list", "propety list"), "is not understood");
    expect_ply_error(replaced("uchar", "float"), "is not understood");
    expect_ply_error(replaced("property float z", "property real z"), "line 7 'property real z' is not understood");
    expect_ply_error(replaced("property float z\n", ""), "have no x, y and z");
    expect_ply_error(replaced("vertex 3", "vertex 4000000000"), "4000000000 elements 'vertex' do not fit");
    expect_ply_error(replaced("face 1", "face 999999999999"), "999999999999 elements 'face' do not fit");
}

TEST(Ply, AHeaderEndsItsLinesAsTheFirstOneDoes) {
    const std::string file = ply(3, TRIANGLE_ROWS, 1, "3 0 1 2\n");
    for (const char* end : {"\r", "\r\n", " \n"})
        EXPECT_EQ(count_triangles(load_ply(replaced(file, "\n", end))), 1u) << end;
    expect_ply_error(replaced(replaced(file, "property list", "propety list"), "\n", "\r"), "line 9 'propety list");
    // If the first byte of the body is 10, it is no line end.
    std::string binary = replaced(binary_ply(false), "\r\n", "\r");
    const double ten = 0x0.000000000000ap-1022;  // its lowest byte
    std::memcpy(binary.data() + binary.find("end_header\r") + 11, &ten, sizeof ten);
    ASSERT_EQ(binary[binary.find("end_header\r") + 11], '\n');
    EXPECT_EQ(load_ply(binary).meshes[0].positions[1], vec3(1, 0, -0.25f));
}

// Returns a file with the `count` strips of `lists`, about two squares.
std::string strips(int count, const std::string& lists) {
    return text("ply\nformat ascii 1.0\nelement vertex 8\n", POSITIONS, "element tristrips ", count,
                "\nproperty list int int vertex_indices\nend_header\n",
                "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 0 0\n3 0 0\n2 1 0\n3 1 0\n", lists);
}

TEST(Ply, StripsBecomeTrianglesThatFaceOneWay) {
    const std::vector<uvec3> squares = {{0, 1, 2}, {1, 3, 2}, {4, 5, 6}, {5, 7, 6}};
    for (const std::string& file : {strips(1, "9 0 1 2 3 -1 4 5 6 7\n"), strips(2, "4 0 1 2 3\n5 4 5 6 7 -1\n"),
                                    strips(1, "15 -1 -1 0 1 2 3 -1 0 1 -1 4 5 6 7 -1\n")}) {
        const Scene scene = load_ply(file);
        EXPECT_EQ(scene.meshes[0].triangles, squares);
        EXPECT_TRUE(scene.warnings.empty()) << joined(scene.warnings);
    }
    expect_ply_error(strips(1, "4 0 1 2 8\n"), "face 1 has vertex index 8, but there are only 8 vertices");
    expect_ply_error(strips(1, "4 0 1 2 -2\n"), "face 1 has vertex index -2");
    expect_ply_error(strips(1, "2 0 1\n"), "has 8 vertices but no faces");
}

TEST(Ply, ANormalThatIsNoNumberIsNone) {
    const Mesh mesh = load_ply("ply\nformat ascii 1.0\nelement vertex 3\n" + POSITIONS +
                               "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n" + FACE_LIST +
                               "end_header\n0 0 0 0 0 1\n1 0 0 nan nan nan\n0 1 0 -1.#IND 0 1\n3 0 1 2\n")
                          .meshes[0];
    EXPECT_EQ(mesh.normals, (std::vector<vec3>{{0, 0, 1}, vec3(0), vec3(0)}));
}

TEST(Ply, APolygonOfManyCornersIsCoveredOnceAndACrossingOneTold) {
    std::string vertices, face = "802";
    for (int i = 0; i < 401; ++i) vertices += text(i, ' ', i % 2 + 2, " 0\n");
    for (int i = 400; i >= 0; --i) vertices += text(i, ' ', i % 2, " 0\n");
    for (int i = 0; i < 802; ++i) face += text(' ', i);
    const std::string list = "property list ushort int vertex_indices\n";
    const Scene scene = load_ply(replaced(ply(802, vertices, 1, face + "\n"), FACE_LIST, list));
    double area = 0;
    for (const uvec3& t : scene.meshes[0].triangles) {
        const std::vector<vec3>& p = scene.meshes[0].positions;
        const float part = cross(p[t.y] - p[t.x], p[t.z] - p[t.x]).z / 2;
        EXPECT_LE(part, 0);
        area -= part;
    }
    EXPECT_EQ(area, 800);
    EXPECT_TRUE(scene.warnings.empty()) << joined(scene.warnings);
    const Scene crossing = load_ply(ply(4, "0 0 0\n1 0 0\n0 1 0\n1 1 0\n", 2, "3 0 1 2\n4 0 1 2 3\n"));
    expect_warnings(crossing, {"1 faces cross themselves, so that their triangles overlap (the first: face 1)"});
}

TEST(Ply, BodyFaultsAreNamed) {
    expect_ply_error(ply(3, TRIANGLE_ROWS, 1, "3 0 1 3\n"), "face 0 has vertex index 3, but there are only 3 vertices");
    expect_ply_error(ply(3, TRIANGLE_ROWS, 2, "3 0 1 2\n3 0 1 -1\n"), "face 1 has vertex index -1");
    expect_ply_error(ply(3, TRIANGLE_ROWS, 1, "3 0 1 0.5\n"), "face 0 has vertex index 0.5");
    expect_ply_error(ply(3, TRIANGLE_ROWS, 1, "3 0 1\n"), "truncated");
    expect_ply_error(ply(3, TRIANGLE_ROWS, 1, "-3 0 1 2\n"), "list claims -3 entries");
    expect_ply_error(ply(3, TRIANGLE_ROWS, 1, "9999 0 1 2\n"), "list claims 9999 entries");
    expect_ply_error(ply(3, "0 0 zero\n", 1, "3 0 1 2\n"), "'zero");
    expect_ply_error(ply(3, "0 0 0x1\n", 1, "3 0 1 2\n"), "'0x1");
    expect_ply_error(ply(3, TRIANGLE_ROWS, 0, ""), "has 3 vertices but no faces");
    const std::string binary = binary_ply(false);
    expect_ply_error(binary.substr(0, binary.size() - 1), "truncated");
}

// Writers of NumPy arrays make such files: see ply_type_of().
TEST(Ply, NamesOfTypesHaveTheirSizes) {
    const std::map<std::string, std::size_t> sizes = {
        {"char", 1},   {"int8", 1},    {"uchar", 1}, {"uint8", 1},   {"short", 2},  {"int16", 2},  {"ushort", 2},
        {"uint16", 2}, {"int", 4},     {"int32", 4}, {"uint", 4},    {"uint32", 4}, {"int64", 8},  {"uint64", 8},
        {"half", 2},   {"float16", 2}, {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
    for (const auto& [name, size] : sizes) {
        ASSERT_TRUE(ply_type_of(name)) << name;
        EXPECT_EQ(size_of(*ply_type_of(name)), size) << name;
    }
    EXPECT_FALSE(ply_type_of("float128"));
}

TEST(Ply, VerticesHaveColours) {
    const Scene scene = load_ply("ply\nformat ascii 1.0\nelement vertex 3\n" + POSITIONS +
                                 "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n" +
                                 FACE_LIST + "end_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 128\n3 0 1 2\n");
    EXPECT_TRUE(scene.warnings.empty());
    EXPECT_EQ(scene.meshes[0].colors[0], vec4(1, 0, 0, 1));
    EXPECT_EQ(scene.meshes[0].colors[2].z, linear_of_srgb(128 / 255.0f));
    EXPECT_EQ(scene.materials[0].metallic, 0);
}

// Two triangles share an edge; at its vertices they have different texture coordinates.
const std::string WEDGES =
    "ply\nformat ascii 1.0\ncomment TextureFile my wall.png\nelement vertex 4\n" + POSITIONS + "element face 2\n" +
    FACE_LIST + "property list uchar float texcoord\nproperty uchar red\nproperty uchar green\nend_header\n" +
    TRIANGLE_ROWS + "1 1 0\n3 0 1 2 6 0 0 1 0 0 1 9 9\n3 2 1 3 6 0 1 0.5 0 1 1 9 9\n";

TEST(Ply, CornersOfFacesHaveTextureCoordinates) {
    const Scene scene = load_ply(WEDGES);
    const Mesh& mesh = scene.meshes[0];
    ASSERT_EQ(mesh.positions.size(), 5u);  // vertex 1 has two
    EXPECT_EQ(mesh.uvs.size(), 5u);
    EXPECT_EQ(mesh.uvs[mesh.triangles[0].y], vec2(1, 1));
    EXPECT_EQ(mesh.uvs[mesh.triangles[1].y], vec2(0.5f, 1));
    EXPECT_EQ(mesh.positions[mesh.triangles[1].y], vec3(1, 0, 0));
    EXPECT_EQ(mesh.triangles[0].z, mesh.triangles[1].x);
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].base_color_texture.image, 0);
    EXPECT_TRUE(scene.images[0].is_placeholder);
    expect_warnings(scene, {"'colours' (line 11)", "picture 'my wall.png' is shown as a checkerboard"});
}

TEST(Ply, FacesNameTheirPicture) {
    const Scene scene = load_ply(
        "ply\nformat ascii 1.0\ncomment TextureFile a.png\ncomment TextureFile b.png\n"
        "element vertex 4\n" +
        POSITIONS + "element face 2\n" + FACE_LIST +
        "property list uchar float texcoord\nproperty int texnumber\nend_header\n" + TRIANGLE_ROWS +
        "1 1 0\n3 0 1 2 6 0 0 1 0 0 1 1\n3 2 1 3 6 0 1 1 0 1 1 0\n");
    EXPECT_EQ(scene.meshes[0].materials, (std::vector<uint>{1, 0}));
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.materials[1].name, "b.png");
}

TEST(Ply, APictureWithoutCoordinatesIsNamed) {
    const Scene scene = load_ply("ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 3\n" + POSITIONS +
                                 "element face 1\n" + FACE_LIST + "end_header\n" + TRIANGLE_ROWS + "3 0 1 2\n");
    expect_warnings(scene, {"picture 'a.png' is not shown"});
}

}  // namespace
}  // namespace twinray::test
