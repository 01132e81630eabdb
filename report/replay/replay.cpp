#include "report/replay/replay.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>

#include "engine/core/error.h"
#include "engine/core/fnv1a.h"
#include "engine/core/platform.h"
#include "engine/core/json_input.h"

namespace twinray::replay {
namespace {

using nlohmann::json;

constexpr const char* schema = "twinray-replay/1";

template <class Number>
std::string hexadecimal(Number value) {
    return text(std::hexfloat, value);
}

double number(const json& word) {
    const std::string text = word.get<std::string>();
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0') fail("'", text, "' is not a number");
    return value;
}

float float_of(const json& word) { return static_cast<float>(number(word)); }  // exact: it was written as a float

json words(vec3 v) { return {hexadecimal(v.x), hexadecimal(v.y), hexadecimal(v.z)}; }
vec3 vector(const json& words) { return {float_of(words.at(0)), float_of(words.at(1)), float_of(words.at(2))}; }

template <class HitType>
json hit_json(const HitType& hit, uint instance, uint primitive) {
    if (!hit.hit) return nullptr;
    return {{"instance", instance},
            {"primitive", primitive},
            {"t", hexadecimal(hit.t)},
            {"u", hexadecimal(hit.u)},
            {"v", hexadecimal(hit.v)}};
}

Hit answer_of(const json& hit) {
    if (hit.is_null()) return miss();
    return {1,
            float_of(hit.at("t")),
            unsigned_of<uint>(hit.at("primitive")),
            0,
            float_of(hit.at("u")),
            float_of(hit.at("v")),
            unsigned_of<uint>(hit.at("instance")),
            0};
}

ReferenceHit reference_hit(const json& hit) {
    if (hit.is_null()) return {};
    return {true,
            number(hit.at("t")),
            number(hit.at("u")),
            number(hit.at("v")),
            unsigned_of<uint>(hit.at("primitive")),
            unsigned_of<uint>(hit.at("instance")),
            0};
}

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

json numbers(vec3 v) { return {v.x, v.y, v.z}; }

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
                                 {"min", numbers(box.lo)},
                                 {"max", numbers(box.hi)}});
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

void write(const std::filesystem::path& file, const Replay& replay) {
    const json object = {
        {"schema", schema},
        {"scene", replay.scene.generic_string()},
        {"scene_hash", replay.scene_hash},
        {"backend", replay.backend},
        {"level", replay.level},
        {"class", replay.kind},
        {"ray",
         {{"origin", words(replay.ray.origin)},
          {"direction", words(replay.ray.direction)},
          {"t_min", hexadecimal(replay.ray.t_min)},
          {"t_max", hexadecimal(replay.ray.t_max)}}},
        {"answer", hit_json(replay.answer, replay.answer.instance_index, replay.answer.primitive_index)},
        {"reference", hit_json(replay.reference, replay.reference.instance, replay.reference.primitive)},
        {"device", replay.device},
        {"driver", replay.driver},
        {"twinray", replay.twinray}};
    std::ofstream out(file);
    out << object.dump(2) << '\n';
    if (!out.flush()) fail("replay '", file.string(), "' cannot be written");
}

Replay read(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) fail("replay '", file.string(), "' cannot be opened");
    try {
        const json object = parse_json<json>(in);
        if (object.at("schema") != schema) fail("its schema is ", object.at("schema").dump(), ", not ", schema);
        const json& ray = object.at("ray");
        return {platform::path_of(object.at("scene").get<std::string>()),
                object.at("scene_hash").get<std::string>(),
                object.at("backend").get<std::string>(),
                object.at("level").get<std::string>(),
                object.at("class").get<std::string>(),
                {vector(ray.at("origin")), float_of(ray.at("t_min")), vector(ray.at("direction")),
                 float_of(ray.at("t_max"))},
                answer_of(object.at("answer")),
                reference_hit(object.at("reference")),
                object.at("device").get<std::string>(),
                object.at("driver").get<std::string>(),
                object.at("twinray").get<std::string>()};
    } catch (const std::exception& error) {
        fail("replay '", file.string(), "': ", error.what());
    }
}

std::size_t write_faults(const std::filesystem::path& folder, const std::string& set, std::span<const Fault> faults,
                         bool with_driver, Replay common, const std::function<ReferenceHit(const Ray&)>& reference) {
    std::filesystem::create_directories(folder);
    const std::string backend_of_driver = common.backend;
    std::map<HitClass, std::size_t> numbers;
    std::size_t written = 0;
    for (const Fault& fault : faults) {
        if (!with_driver && !fault.is_of_software) continue;
        common.backend = fault.is_of_software ? "sw" : backend_of_driver;
        common.kind = name_of(fault.kind);
        common.ray = fault.ray;
        common.answer = fault.answer;
        common.reference = reference(fault.ray);
        write(folder / text(set, '-', common.kind, '-', ++numbers[fault.kind], ".json"), common);
        ++written;
    }
    return written;
}

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
