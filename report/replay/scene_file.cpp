// SPDX-License-Identifier: MIT
#include "report/replay/scene_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <fstream>

#include "engine/core/error.h"
#include "engine/core/fnv1a.h"

namespace twinray::replay {
namespace {

using nlohmann::json;

Mesh mesh_of(const Geometry64& geometry) {
    Mesh mesh;
    const std::size_t count = std::max<std::size_t>(geometry.triangle_count(), 1);  // glTF has no empty mesh
    mesh.positions.resize(3 * count, vec3(0));
    for (uint primitive = 0; primitive < count; ++primitive) {
        mesh.triangles.push_back(uvec3(3 * primitive, 3 * primitive + 1, 3 * primitive + 2));
        if (const ActiveTriangle* active = geometry.find(primitive))
            std::ranges::copy(active->vertices, mesh.positions.begin() + 3 * std::ptrdiff_t{primitive});
    }
    return mesh;
}

Transform transform_of(const Placement64& placement) {
    Transform transform;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            transform.rows[static_cast<std::size_t>(row)][column] = static_cast<float>(placement.to_world[column][row]);
        transform.rows[static_cast<std::size_t>(row)].w = static_cast<float>(placement.offset[row]);
    }
    return transform;
}

std::vector<float> matrix_of(const Transform& transform) {  // by columns
    std::vector<float> matrix;
    for (int column = 0; column < 4; ++column) {
        for (const vec4& row : transform.rows) matrix.push_back(row[column]);
        matrix.push_back(column == 3 ? 1.0f : 0.0f);
    }
    return matrix;
}

template <class T>
std::size_t append(std::vector<char>& bytes, const std::vector<T>& values) {
    const std::size_t first = bytes.size();
    bytes.resize(first + values.size() * sizeof(T));
    std::memcpy(bytes.data() + first, values.data(), values.size() * sizeof(T));
    return first;
}

json vector(vec3 v) { return {v.x, v.y, v.z}; }

void add_mesh(json& gltf, std::vector<char>& bytes, const Mesh& mesh) {
    constexpr int float32 = 5126, uint32 = 5125;
    const Bounds box = bounds_of(MeshView(mesh));
    const std::size_t view = gltf["bufferViews"].size();
    gltf["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", append(bytes, mesh.positions)}, {"byteLength", 12 * mesh.positions.size()}});
    gltf["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", append(bytes, mesh.triangles)}, {"byteLength", 12 * mesh.triangles.size()}});
    gltf["accessors"].push_back({{"bufferView", view},
                                 {"componentType", float32},
                                 {"count", mesh.positions.size()},
                                 {"type", "VEC3"},
                                 {"min", vector(box.lo)},
                                 {"max", vector(box.hi)}});
    gltf["accessors"].push_back({{"bufferView", view + 1},
                                 {"componentType", uint32},
                                 {"count", 3 * mesh.triangles.size()},
                                 {"type", "SCALAR"}});
    gltf["meshes"].push_back(
        {{"primitives", {{{"attributes", {{"POSITION", view}}}, {"indices", view + 1}, {"mode", 4}}}}});
}

void write_chunk(std::ostream& out, const char* type, const char* bytes, std::size_t size) {
    const auto length = static_cast<std::uint32_t>(size);
    out.write(reinterpret_cast<const char*>(&length), 4)
        .write(type, 4)
        .write(bytes, static_cast<std::streamsize>(size));
}

}  // namespace

Scene scene_of(const ReferenceScene& reference) {
    Scene scene;
    const Geometry64* last = nullptr;  // instances of one mesh are adjacent, as push() places them
    for (uint i = 0; i < reference.instance_count(); ++i) {
        if (&reference.geometry(i) != last) scene.meshes.push_back(mesh_of(reference.geometry(i)));
        last = &reference.geometry(i);
        scene.instances.push_back(
            {"", static_cast<uint>(scene.meshes.size() - 1), transform_of(reference.placement(i))});
    }
    return scene;
}

void write_glb(const std::filesystem::path& file, const Scene& scene) {
    json gltf = {{"asset", {{"version", "2.0"}, {"generator", "twinray"}}}, {"scene", 0}};
    std::vector<char> bytes;
    for (const Mesh& mesh : scene.meshes) add_mesh(gltf, bytes, mesh);
    for (const Instance& instance : scene.instances) {
        gltf["scenes"][0]["nodes"].push_back(gltf["nodes"].size());
        gltf["nodes"].push_back({{"mesh", instance.mesh}, {"matrix", matrix_of(instance.transform)}});
    }
    gltf["buffers"].push_back({{"byteLength", bytes.size()}});
    std::string head = gltf.dump();
    head.resize((head.size() + 3) / 4 * 4, ' ');
    const auto total = static_cast<std::uint32_t>(12 + 8 + head.size() + 8 + bytes.size());
    const std::array<std::uint32_t, 3> header = {0x46546c67, 2, total};
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(header.data()), sizeof header);
    write_chunk(out, "JSON", head.data(), head.size());
    write_chunk(out, "BIN\0", bytes.data(), bytes.size());
    if (!out.flush()) fail("scene '", file.string(), "' cannot be written");
}

std::string hash_of(const Scene& scene) {
    Fnv1a hash;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[instance.mesh];
        hash.add_bytes(std::span(mesh.positions));
        hash.add_bytes(std::span(mesh.triangles));
        hash.add_bytes(std::span(&instance.transform, 1));
    }
    return twinray::hexadecimal(hash.value());
}

Scene load_traced_scene(const std::filesystem::path& file, const Replay& replay) {
    const std::filesystem::path path = file.parent_path() / replay.scene;
    Scene scene = load_scene(path);
    const std::string hash = hash_of(scene);
    if (hash == replay.scene_hash) return scene;
    Scene as_written = load_scene(path, dvec3(0));
    if (hash_of(as_written) == replay.scene_hash) return as_written;
    fail("replay '", file.string(), "': scene '", path.string(), "' is not the scene that was traced: its hash is ",
         hash, ", not ", replay.scene_hash);
}

}  // namespace twinray::replay
