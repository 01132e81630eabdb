// Compressed glTF, whose streams are made by the libraries that also decode them; and .glb files that twinray writes.
#include <gtest/gtest.h>

#include "engine/core/files.h"
#include "engine/scene/glb.h"
#include "tests/scene/gltf_builder.h"
#include "twinray/glsl/vector_math.h"

#ifdef TWINRAY_HAS_MESHOPT
#include <meshoptimizer.h>
#endif
#ifdef TWINRAY_HAS_DRACO
#include <draco/compression/encode.h>
#endif

namespace twinray::test {
namespace {

const std::vector<vec3> SQUARE = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 3}};
const std::vector<uint> SQUARE_FACES = {0, 1, 2, 2, 1, 3};

#ifdef TWINRAY_HAS_MESHOPT

// One triangle whose two views are compressed, as gltfpack writes them.
struct MeshoptFile {
    GltfBuilder gltf = one_triangle();
    json root;

    explicit MeshoptFile(const std::string& extension, std::uint8_t first_byte = 0xa0) {
        gltf.buffer.clear();
        std::string vertices(meshopt_encodeVertexBufferBound(SQUARE.size(), sizeof(vec3)), '\0');
        vertices.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(vertices.data()), vertices.size(),
                                                   SQUARE.data(), SQUARE.size(), sizeof(vec3)));
        std::string faces(meshopt_encodeIndexBufferBound(SQUARE_FACES.size(), SQUARE.size()), '\0');
        faces.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(faces.data()), faces.size(),
                                               SQUARE_FACES.data(), SQUARE_FACES.size()));
        if (first_byte != 0xa0) vertices[0] = static_cast<char>(first_byte);
        gltf.buffer = vertices + faces;
        root = json::parse(gltf.with_data_uri());
        root["buffers"].push_back({{"byteLength", 72}, {"extensions", {{extension, {{"fallback", true}}}}}});
        root["extensionsRequired"] = {extension};
        root["bufferViews"] = {view(extension, 0, vertices.size(), sizeof(vec3), SQUARE.size(), "ATTRIBUTES"),
                               view(extension, vertices.size(), faces.size(), 4, SQUARE_FACES.size(), "TRIANGLES")};
        root["accessors"][0]["count"] = SQUARE.size();
        root["accessors"][1]["count"] = SQUARE_FACES.size();
        root["accessors"][1]["componentType"] = 5125;
    }

    static json view(const std::string& extension, std::size_t offset, std::size_t length, std::size_t stride,
                     std::size_t count, const char* mode) {
        return {{"buffer", 1},
                {"byteLength", count * stride},
                {"extensions",
                 {{extension,
                   {{"buffer", 0},
                    {"byteOffset", offset},
                    {"byteLength", length},
                    {"byteStride", stride},
                    {"count", count},
                    {"mode", mode}}}}}};
    }

    static std::string with_buffer(const std::string& bytes) {
        GltfBuilder other = one_triangle();
        other.buffer = bytes;
        return other.with_data_uri();
    }

    json& stream(std::size_t index) { return root["bufferViews"][index]["extensions"].front(); }
    std::string error() const {
        return error_of([&] { load_text(root.dump(), "test.gltf"); });
    }
};

TEST(GltfMeshopt, BothExtensionsAreDecoded) {
    for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        const Scene scene = load_text(MeshoptFile(extension).root.dump(), "test.gltf");
        EXPECT_EQ(scene.meshes[0].positions, SQUARE);
        EXPECT_EQ(scene.meshes[0].triangles.size(), 2u);
        EXPECT_TRUE(scene.warnings.empty());
    }
}

TEST(GltfMeshopt, AFilterIsUndone) {
    const std::vector<vec3> values = {{0, 0, 0}, {1.5f, 0, 0}, {0, -2, 0}, {0.25f, 1, 3}};
    // The specification's words: 8 bits of an exponent, here -2, above 24 bits of a whole number. The library's own
    // function for them takes other arguments in 0.22 than in 0.18.
    std::vector<uvec3> filtered;
    const auto word = [](float value) { return uint(-2) << 24 | (uint(int(value * 4)) & 0xffffff); };
    for (const vec3 value : values) filtered.push_back({word(value.x), word(value.y), word(value.z)});
    std::string stream(meshopt_encodeVertexBufferBound(values.size(), sizeof(vec3)), '\0');
    stream.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(stream.data()), stream.size(),
                                             filtered.data(), filtered.size(), sizeof(uvec3)));
    MeshoptFile file("EXT_meshopt_compression");
    file.root["buffers"].push_back(json::parse(MeshoptFile::with_buffer(stream))["buffers"][0]);
    file.stream(0)["buffer"] = 2;
    file.stream(0)["byteLength"] = stream.size();
    file.stream(0)["filter"] = "EXPONENTIAL";
    EXPECT_EQ(load_text(file.root.dump(), "test.gltf").meshes[0].positions, values);
}

TEST(GltfMeshopt, IndicesOfAnyOrderAreDecoded) {
    std::string stream(meshopt_encodeIndexSequenceBound(SQUARE_FACES.size(), SQUARE.size()), '\0');
    stream.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(stream.data()), stream.size(),
                                              SQUARE_FACES.data(), SQUARE_FACES.size()));
    MeshoptFile file("EXT_meshopt_compression");
    file.root["buffers"].push_back(json::parse(MeshoptFile::with_buffer(stream))["buffers"][0]);
    file.stream(1)["buffer"] = 2;
    file.stream(1)["byteOffset"] = 0;
    file.stream(1)["byteLength"] = stream.size();
    file.stream(1)["mode"] = "INDICES";
    EXPECT_EQ(load_text(file.root.dump(), "test.gltf").meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}, {2, 1, 3}}));
}

TEST(GltfMeshopt, StreamsThatDoNotFitAreNamed) {
    const auto expect = [](auto bend, const std::string& part) {
        MeshoptFile file("EXT_meshopt_compression");
        bend(file);
        expect_contains(file.error(), part);
    };
    expect([](MeshoptFile& file) { file.stream(0)["count"] = 1u << 30; }, "times the");
    expect([](MeshoptFile& file) { file.stream(0)["byteStride"] = 14; }, "mode ATTRIBUTES with 4 elements of 14 bytes");
    expect([](MeshoptFile& file) { file.stream(0)["mode"] = "POINTS"; }, "unknown mode 'POINTS'");
    expect([](MeshoptFile& file) { file.stream(0)["filter"] = "OCTAHEDRAL"; },
           "filter 'OCTAHEDRAL' with a stride of 12");
    expect([](MeshoptFile& file) { file.stream(0)["byteLength"] = 1u << 20; }, "takes 1048576 bytes from byte 0");
    expect([](MeshoptFile& file) { file.stream(0)["buffer"] = 9; }, "the file has 2");
    expect([](MeshoptFile& file) { file.stream(0)["byteLength"] = 4; }, "is damaged");
    expect([](MeshoptFile& file) { file.stream(1)["count"] = 5; }, "mode TRIANGLES with 5 elements");
}

TEST(GltfMeshopt, AStreamForANewerLibraryIsNamedWithTheRemedy) {
    if (MESHOPTIMIZER_VERSION >= 230) GTEST_SKIP() << "this libmeshoptimizer decodes the newer stream";
    const std::string error = MeshoptFile("KHR_meshopt_compression", 0xa1).error();
    expect_contains(error, "newer libmeshoptimizer");
    expect_contains(error, "gltfpack -noq -kn -km");
}

#endif

#ifdef TWINRAY_HAS_DRACO

// Adds an attribute: each component of vertex i is i steps.
template <class T>
void add_draco_integers(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType number,
                        std::uint8_t components, int step) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, static_cast<std::int8_t>(components), number, true, sizeof(T) * components, 0);
    const int id = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(SQUARE.size()));
    for (std::uint32_t i = 0; i < SQUARE.size(); ++i) {
        const std::vector<T> values(components, static_cast<T>(i * static_cast<std::uint32_t>(step)));
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), values.data());
    }
}

// Returns a stream with colours and texture coordinates, as integers.
std::string draco_stream() {
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(SQUARE.size()));
    mesh.SetNumFaces(SQUARE_FACES.size() / 3);
    for (std::uint32_t i = 0; i < SQUARE_FACES.size() / 3; ++i)
        mesh.SetFace(draco::FaceIndex(i),
                     {{draco::PointIndex(SQUARE_FACES[3 * i]), draco::PointIndex(SQUARE_FACES[3 * i + 1]),
                       draco::PointIndex(SQUARE_FACES[3 * i + 2])}});
    draco::GeometryAttribute positions;
    positions.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, sizeof(vec3), 0);
    const int id = mesh.AddAttribute(positions, true, static_cast<std::uint32_t>(SQUARE.size()));
    for (std::uint32_t i = 0; i < SQUARE.size(); ++i)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &SQUARE[i]);
    add_draco_integers<std::uint8_t>(mesh, draco::GeometryAttribute::COLOR, draco::DT_UINT8, 4, 51);
    add_draco_integers<std::uint16_t>(mesh, draco::GeometryAttribute::TEX_COORD, draco::DT_UINT16, 2, 13107);
    draco::Encoder encoder;
    encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);  // keeps the order
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
    return {buffer.data(), buffer.size()};
}

GltfBuilder draco_file(const std::string& stream) {
    GltfBuilder gltf = one_triangle();
    const int view = gltf.add_view(stream);
    gltf.root["accessors"] = {{{"componentType", 5126}, {"count", SQUARE.size()}, {"type", "VEC3"}},
                              {{"componentType", 5123}, {"count", SQUARE_FACES.size()}, {"type", "SCALAR"}},
                              {{"componentType", 5121}, {"count", 4}, {"type", "VEC4"}, {"normalized", true}},
                              {{"componentType", 5123}, {"count", 4}, {"type", "VEC2"}, {"normalized", true}}};
    gltf.primitive()["attributes"]["COLOR_0"] = 2;
    gltf.primitive()["attributes"]["TEXCOORD_0"] = 3;
    gltf.primitive()["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view}, {"attributes", {{"POSITION", 0}, {"COLOR_0", 1}, {"TEXCOORD_0", 2}}}};
    gltf.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return gltf;
}

TEST(GltfDraco, PrimitivesAreDecoded) {
    const Scene scene = draco_file(draco_stream()).load();
    EXPECT_EQ(scene.meshes[0].positions, SQUARE);
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}, {2, 1, 3}}));
    EXPECT_EQ(scene.meshes[0].colors[3], vec4(0.6f));
    EXPECT_EQ(scene.meshes[0].uvs[2], vec2(0.4f));
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfDraco, PlainDataBesideAStreamAreTaken) {
    GltfBuilder gltf = one_triangle();
    gltf.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", gltf.add_view("nothing")},
                                                                    {"attributes", {{"POSITION", 0}}}};
    gltf.root["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.meshes[0].triangles.size(), 1u);
}

TEST(GltfDraco, StreamsThatDoNotFitAreNamed) {
    const std::string good = draco_stream();
    expect_contains(draco_file(good.substr(0, 8)).error(), "has no header");
    expect_contains(draco_file(good.substr(0, good.size() - 9)).error(), "libdraco cannot decode it");
    std::string many = good.substr(0, 11) + "\xff\xff\xff\xff\x0f\x04" + good.substr(13);
    expect_contains(draco_file(many).error(), "claims 4294967295 faces");
    GltfBuilder other = draco_file(good);
    other.root["accessors"][0]["count"] = 3;
    expect_contains(other.error(), "POSITION has 4 elements in the stream, but its accessor 3");
    other = draco_file(good);
    other.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = 7;
    expect_contains(other.error(), "no attribute 7 for POSITION");
}

#endif

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
