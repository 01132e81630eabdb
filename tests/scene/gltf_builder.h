// Small glTF files for tests: they are valid by default, and `root` changes them.
#pragma once

#include <nlohmann/json.hpp>

#include "tests/scene/load_text.h"

namespace twinray::test {

using nlohmann::json;

inline std::string base64(const std::string& bytes) {
    const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

struct GltfBuilder {
    json root = {{"asset", {{"version", "2.0"}}}};
    std::string buffer;

    int append(const char* list, const json& entry) {
        root[list].push_back(entry);
        return static_cast<int>(root[list].size()) - 1;
    }

    int add_view(const std::string& bytes) {
        const std::size_t offset = buffer.size();
        buffer += bytes;
        buffer.resize((buffer.size() + 3) / 4 * 4);
        return append("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}});
    }

    // An accessor of numbers of type T, e.g. add<float>("VEC3", 5126, {...}).
    template <class T>
    int add(const std::string& type, int component_type, const std::vector<T>& values) {
        const std::size_t components = type == "SCALAR" ? 1
                                       : type == "MAT4" ? 16
                                                        : static_cast<std::size_t>(type[3] - '0');
        std::string bytes(values.size() * sizeof(T), '\0');
        if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
        return append("accessors", {{"bufferView", add_view(bytes)},
                                    {"componentType", component_type},
                                    {"count", values.size() / components},
                                    {"type", type}});
    }
    int add_floats(const std::string& type, const std::vector<float>& values) { return add(type, 5126, values); }
    int add_indices(const std::vector<std::uint16_t>& values) { return add("SCALAR", 5123, values); }

    int add_node(const json& node) {
        const int index = append("nodes", node);
        root["scenes"][0]["nodes"].push_back(index);
        return index;
    }

    // Adds an animation in which a node's `path` takes these values, of this type, at these times.
    void animate(int node, const std::string& path, const std::vector<float>& times, const std::string& type,
                 const std::vector<float>& values) {
        const int input = add_floats("SCALAR", times), output = add_floats(type, values);
        append("animations", {{"samplers", {{{"input", input}, {"output", output}}}},
                              {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
    }

    json& primitive(std::size_t index = 0) { return root["meshes"][0]["primitives"][index]; }

    std::string with_data_uri() const {
        json file = root;
        file["buffers"] = {
            {{"byteLength", buffer.size()}, {"uri", "data:application/octet-stream;base64," + base64(buffer)}}};
        return file.dump();
    }

    std::string as_glb() const {
        json file = root;
        file["buffers"] = {{{"byteLength", buffer.size()}}};
        std::string source = file.dump();
        source.resize((source.size() + 3) / 4 * 4, ' ');
        const auto word = [](std::size_t value) {
            const auto narrow = static_cast<std::uint32_t>(value);
            return std::string(reinterpret_cast<const char*>(&narrow), 4);
        };
        return "glTF" + word(2) + word(28 + source.size() + buffer.size()) + word(source.size()) + "JSON" + source +
               word(buffer.size()) + std::string("BIN\0", 4) + buffer;
    }

    Scene load() const { return load_text(with_data_uri(), "test.gltf"); }
    std::string error() const {
        return error_of([&] { load(); });
    }
};

// Mesh 0 'tri' with one triangle (0,0,0) (1,0,0) (0,1,0), indexed, placed by node 0 'node'.
inline GltfBuilder one_triangle() {
    GltfBuilder gltf;
    gltf.root["scene"] = 0;
    gltf.root["scenes"] = {{{"nodes", json::array()}}};
    const int positions = gltf.add_floats("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int indices = gltf.add_indices({0, 1, 2});
    const json primitive = {{"attributes", {{"POSITION", positions}}}, {"indices", indices}};
    gltf.append("meshes", {{"name", "tri"}, {"primitives", {primitive}}});
    gltf.add_node({{"name", "node"}, {"mesh", 0}});
    return gltf;
}

// Changes of a file: what a JSON pointer names becomes this, or an accessor of these numbers, or is gone.
using Bend = std::function<void(GltfBuilder&)>;
inline Bend set(const std::string& pointer, const json& value) {
    return [=](GltfBuilder& gltf) { gltf.root[json::json_pointer(pointer)] = value; };
}
inline Bend set_floats(const std::string& pointer, const std::string& type, const std::vector<float>& values) {
    return [=](GltfBuilder& gltf) { gltf.root[json::json_pointer(pointer)] = gltf.add_floats(type, values); };
}
inline Bend without(const std::string& pointer) {
    return [=](GltfBuilder& gltf) {
        const json::json_pointer gone(pointer);
        gltf.root[gone.parent_pointer()].erase(gone.back());
    };
}
inline Bend all_of(const std::vector<Bend>& bends) {
    return [=](GltfBuilder& gltf) {
        for (const Bend& bend : bends) bend(gltf);
    };
}

// A change that makes a file wrong, and a part of the error's text.
struct Fault {
    const char* name;
    Bend bend;
    std::string message;
};
inline std::string fault_name(const testing::TestParamInfo<Fault>& fault) { return fault.param.name; }

// True when some warning of the scene contains the text.
inline bool has_warning(const Scene& scene, const std::string& part) {
    for (const std::string& warning : scene.warnings)
        if (warning.find(part) != std::string::npos) return true;
    return false;
}

}  // namespace twinray::test
