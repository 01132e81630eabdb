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

TEST(GltfMeshopt, StreamsThatDoNotFitAreNamed) {
    const auto expect = [](auto bend, const std::string& part) {
        MeshoptFile file("EXT_meshopt_compression");
        bend(file);
        expect_contains(file.error(), part);
    };
    expect([](MeshoptFile& file) { file.stream(0)["count"] = 1u << 30; }, "bufferView 0 EXT_meshopt_compression");
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
                              {{"componentType", 5123}, {"count", FACES.size()}, {"type", "SCALAR"}}};
    gltf.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                                    {"attributes", {{"POSITION", 0}}}};
    gltf.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return gltf;
}

TEST(GltfDraco, PrimitivesAreDecoded) {
    const Scene scene = draco_file(draco_stream()).load();
    EXPECT_EQ(scene.meshes[0].positions, CORNERS);
    EXPECT_EQ(scene.meshes[0].triangles, (std::vector<uvec3>{{0, 1, 2}, {2, 1, 3}}));
    EXPECT_TRUE(scene.warnings.empty());
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
