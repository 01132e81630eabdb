// SPDX-License-Identifier: MIT
// Compressed glTF: streams are made by the libraries that also decode them.
#include <gtest/gtest.h>

#include "tests/scene/gltf_builder.h"

#ifdef TWINRAY_HAS_MESHOPT
#include <meshoptimizer.h>
#endif
#ifdef TWINRAY_HAS_DRACO
#include <draco/compression/encode.h>
#endif

namespace twinray::test {
namespace {

const std::vector<vec3> CORNERS = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 3}};
const std::vector<uint> FACES = {0, 1, 2, 2, 1, 3};

#ifdef TWINRAY_HAS_MESHOPT

// One triangle whose two views are compressed, as gltfpack writes them.
struct MeshoptFile {
    GltfBuilder gltf = one_triangle();
    json root;

    explicit MeshoptFile(const std::string& extension, std::uint8_t first_byte = 0xa0) {
        gltf.buffer.clear();
        std::string vertices(meshopt_encodeVertexBufferBound(CORNERS.size(), sizeof(vec3)), '\0');
        vertices.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(vertices.data()), vertices.size(),
                                                   CORNERS.data(), CORNERS.size(), sizeof(vec3)));
        std::string faces(meshopt_encodeIndexBufferBound(FACES.size(), CORNERS.size()), '\0');
        faces.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(faces.data()), faces.size(),
                                               FACES.data(), FACES.size()));
        if (first_byte != 0xa0) vertices[0] = static_cast<char>(first_byte);
        gltf.buffer = vertices + faces;
        root = json::parse(gltf.with_data_uri());
        root["buffers"].push_back({{"byteLength", 72}, {"extensions", {{extension, {{"fallback", true}}}}}});
        root["extensionsRequired"] = {extension};
        root["bufferViews"] = {view(extension, 0, vertices.size(), sizeof(vec3), CORNERS.size(), "ATTRIBUTES"),
                               view(extension, vertices.size(), faces.size(), 4, FACES.size(), "TRIANGLES")};
        root["accessors"][0]["count"] = CORNERS.size();
        root["accessors"][1]["count"] = FACES.size();
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
        EXPECT_EQ(scene.meshes[0].positions, CORNERS);
        EXPECT_EQ(scene.meshes[0].triangles.size(), 2u);
        EXPECT_TRUE(scene.warnings.empty());
    }
}

TEST(GltfMeshopt, AFilterIsUndone) {
    const std::vector<vec3> values = {{0, 0, 0}, {1.5f, 0, 0}, {0, -2, 0}, {0.25f, 1, 3}};
    std::vector<vec3> filtered(values.size());
    meshopt_encodeFilterExp(filtered.data(), values.size(), sizeof(vec3), 15, &values[0].x);
    std::string stream(meshopt_encodeVertexBufferBound(values.size(), sizeof(vec3)), '\0');
    stream.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(stream.data()), stream.size(),
                                             filtered.data(), filtered.size(), sizeof(vec3)));
    MeshoptFile file("EXT_meshopt_compression");
    file.root["buffers"].push_back(json::parse(MeshoptFile::with_buffer(stream))["buffers"][0]);
    file.stream(0)["buffer"] = 2;
    file.stream(0)["byteLength"] = stream.size();
    file.stream(0)["filter"] = "EXPONENTIAL";
    EXPECT_EQ(load_text(file.root.dump(), "test.gltf").meshes[0].positions, values);
}

TEST(GltfMeshopt, IndicesOfAnyOrderAreDecoded) {
    std::string stream(meshopt_encodeIndexSequenceBound(FACES.size(), CORNERS.size()), '\0');
    stream.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(stream.data()), stream.size(),
                                              FACES.data(), FACES.size()));
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
    const int id = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(CORNERS.size()));
    for (std::uint32_t i = 0; i < CORNERS.size(); ++i) {
        const std::vector<T> values(components, static_cast<T>(i * static_cast<std::uint32_t>(step)));
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), values.data());
    }
}

// Returns a stream with colours and texture coordinates, as integers.
std::string draco_stream() {
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(CORNERS.size()));
    mesh.SetNumFaces(FACES.size() / 3);
    for (std::uint32_t i = 0; i < FACES.size() / 3; ++i)
        mesh.SetFace(draco::FaceIndex(i), {{draco::PointIndex(FACES[3 * i]), draco::PointIndex(FACES[3 * i + 1]),
                                            draco::PointIndex(FACES[3 * i + 2])}});
    draco::GeometryAttribute positions;
    positions.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, sizeof(vec3), 0);
    const int id = mesh.AddAttribute(positions, true, static_cast<std::uint32_t>(CORNERS.size()));
    for (std::uint32_t i = 0; i < CORNERS.size(); ++i)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &CORNERS[i]);
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
    gltf.root["accessors"] = {{{"componentType", 5126}, {"count", CORNERS.size()}, {"type", "VEC3"}},
                              {{"componentType", 5123}, {"count", FACES.size()}, {"type", "SCALAR"}},
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
    EXPECT_EQ(scene.meshes[0].positions, CORNERS);
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

}  // namespace
}  // namespace twinray::test
