// SPDX-License-Identifier: MIT
#include "engine/scene/gltf_mesh.h"

#include <map>

#include "engine/scene/gltf_accessor.h"
#include "engine/scene/gltf_variants.h"

namespace twinray {
namespace {

using tinygltf::Primitive;

int attribute_of(const Primitive& primitive, const char* name) {
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
}

bool makes_triangles(const Primitive& primitive) {
    return attribute_of(primitive, "POSITION") >= 0 &&
           (primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
            primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN);
}

// Strips and fans as glTF 2.0 (3.7.2.1) defines their winding.
std::vector<uvec3> assemble(const std::vector<uint>& corners, int mode) {
    std::vector<uvec3> triangles;
    const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
    for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
        const uint a = corners[i], b = corners[i + 1], c = corners[i + 2];
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
            triangles.emplace_back(b, c, corners[0]);
        else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1)
            triangles.emplace_back(a, c, b);
        else
            triangles.emplace_back(a, b, c);
    }
    return triangles;
}

// All that a vertex is made from.
std::vector<int> accessors_of(const Primitive& primitive) {
    std::vector<int> accessors;
    for (const char* name : {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"})
        accessors.push_back(attribute_of(primitive, name));
    for (const auto& [name, accessor] : primitive.attributes)
        if (name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_")) accessors.push_back(accessor);
    for (const auto& target : primitive.targets)
        for (const auto& [name, accessor] : target) accessors.push_back(accessor);
    return accessors;
}

// Puts the primitives of one mesh together.
class MeshReader {
  public:
    MeshReader(GltfFile& file, std::size_t index, uint default_material, bool is_skinned)
        : file_(file),
          source_(file.model.meshes[index]),
          name_(gltf_name("mesh", index, source_.name)),
          default_material_(default_material) {
        mesh_.name = source_.name.empty() ? text("mesh ", index) : source_.name;
        std::vector<const Primitive*> shown;
        for (const Primitive& primitive : source_.primitives) {
            if (!makes_triangles(primitive)) continue;
            shown.push_back(&primitive);
            has_normals_ |= attribute_of(primitive, "NORMAL") >= 0;
            has_uvs_ |= attribute_of(primitive, "TEXCOORD_0") >= 0;
            // Shading derives tangents where a mesh has none, so all or none is right and a mixture is not.
            has_tangents_ &= attribute_of(primitive, "TANGENT") >= 0 && attribute_of(primitive, "NORMAL") >= 0;
        }
        layout_ = motion_layout(file, shown, name_, is_skinned);
        layout_.normals &= has_normals_;
        layout_.tangents &= has_tangents_;
    }

    GltfMesh read() {
        std::size_t skipped = 0;
        for (std::size_t i = 0; i < source_.primitives.size(); ++i)
            if (makes_triangles(source_.primitives[i]))
                add(source_.primitives[i], text(name_, " primitive ", i));
            else
                ++skipped;
        if (skipped)
            file_.warn(text(name_, ": skipped ", skipped, " primitives of points, lines or without positions"));
        return {std::move(mesh_), std::move(motion_), std::move(variants_)};
    }

  private:
    // The arrays of one primitive, with the attributes that the mesh as a whole has.
    struct Vertices {
        std::vector<vec3> positions, normals;
        std::vector<vec4> tangents;
        std::vector<vec2> uvs;
        VertexMotion motion;
    };

    // Where a primitive's vertices lie in mesh_.
    struct Part {
        uint base = 0;
        std::size_t count = 0;
    };

    template <int N>
    std::vector<glm::vec<N, float>> read_attribute(const Primitive& primitive, const char* name,
                                                   std::size_t vertex_count, const std::string& object) const {
        const int accessor = attribute_of(primitive, name);
        if (accessor < 0) return std::vector<glm::vec<N, float>>(vertex_count, glm::vec<N, float>(0));
        auto values = read_vectors<N>(file_, accessor, text(object, " ", name));
        if (values.size() != vertex_count)
            file_.fail(object, ": ", name, " has ", values.size(), " elements, but POSITION has ", vertex_count);
        return values;
    }

    Vertices read_vertices(const Primitive& primitive, const std::string& object) {
        Vertices v;
        v.positions = read_vectors<3>(file_, attribute_of(primitive, "POSITION"), object + " POSITION");
        const std::size_t count = v.positions.size();
        if (has_normals_) v.normals = read_attribute<3>(primitive, "NORMAL", count, object);
        if (has_uvs_) v.uvs = read_attribute<2>(primitive, "TEXCOORD_0", count, object);
        if (has_tangents_) v.tangents = read_attribute<4>(primitive, "TANGENT", count, object);
        v.motion = read_gltf_motion(file_, primitive, layout_, count, object);
        return v;
    }

    uint append_vertices(const Vertices& vertices) {
        const std::size_t base = mesh_.positions.size();
        if (base + vertices.positions.size() > UINT32_MAX) file_.fail(name_, ": has over 2^32 vertices");
        append(mesh_.positions, vertices.positions);
        append(mesh_.normals, vertices.normals);
        append(mesh_.tangents, vertices.tangents);
        append(mesh_.uvs, vertices.uvs);
        append(motion_, vertices.motion);
        return static_cast<uint>(base);
    }

    std::vector<uvec3> read_triangles(const Primitive& primitive, std::size_t vertex_count, const std::string& object) {
        std::vector<uint> corners;
        if (primitive.indices >= 0)
            corners = read_indices(file_, primitive.indices, object + " indices");
        else
            for (uint i = 0; i < vertex_count; ++i) corners.push_back(i);
        for (std::size_t i = 0; i < corners.size(); ++i)
            if (corners[i] >= vertex_count)
                file_.fail(object, ": index ", corners[i], " at position ", i, " is out of range; POSITION has ",
                           vertex_count, " elements");
        if (primitive.mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0)
            file_.warn(text(object, ": ignored ", corners.size() % 3, " corners after the last whole triangle"));
        return assemble(corners, primitive.mode);
    }

    void add(const Primitive& primitive, const std::string& object) {
        note_what_is_ignored(primitive);
        if (has_normals_ && attribute_of(primitive, "NORMAL") < 0) return add_flat(primitive, object);
        const Part part = shared_part(primitive, object);
        add_triangles(read_triangles(primitive, part.count, object), part.base, primitive, object);
    }

    Part shared_part(const Primitive& primitive, const std::string& object) {
        const std::vector<int> key = accessors_of(primitive);
        if (const auto found = parts_.find(key); found != parts_.end()) return found->second;
        const Vertices vertices = read_vertices(primitive, object);
        return parts_[key] = {append_vertices(vertices), vertices.positions.size()};
    }

    // A flat face needs corners of its own.
    void add_flat(const Primitive& primitive, const std::string& object) {
        const Vertices shared = read_vertices(primitive, object);
        Vertices own;
        std::vector<uvec3> own_triangles;
        std::vector<uint> corners;
        for (const uvec3& t : read_triangles(primitive, shared.positions.size(), object)) {
            const uint first = static_cast<uint>(own.positions.size());
            own_triangles.emplace_back(first, first + 1, first + 2);
            corners.insert(corners.end(), {t.x, t.y, t.z});
            const vec3 a = shared.positions[t.x], b = shared.positions[t.y], c = shared.positions[t.z];
            const glm::dvec3 across = glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a));
            const double length = glm::length(across);
            own.positions.insert(own.positions.end(), {a, b, c});
            own.normals.insert(own.normals.end(), 3, length > 0 ? vec3(across / length) : vec3(0, 0, 1));
            if (has_uvs_) own.uvs.insert(own.uvs.end(), {shared.uvs[t.x], shared.uvs[t.y], shared.uvs[t.z]});
        }
        own.motion = picked(shared.motion, corners);
        add_triangles(own_triangles, append_vertices(own), primitive, object);
    }

    void add_triangles(const std::vector<uvec3>& triangles, uint base, const Primitive& primitive,
                       const std::string& object) {
        const std::size_t material_count = file_.model.materials.size();
        if (primitive.material >= 0 && std::size_t(primitive.material) >= material_count)
            file_.fail(name_, ": material ", primitive.material, " does not exist; the file has ", material_count);
        for (const uvec3& triangle : triangles) mesh_.triangles.push_back(triangle + base);
        const std::size_t before = mesh_.materials.size();
        const uint material = primitive.material < 0 ? default_material_ : static_cast<uint>(primitive.material);
        mesh_.materials.resize(mesh_.triangles.size(), material);
        add_variants(read_variant_materials(file_, primitive, object), before);
    }

    // Of the triangles from the first on, which have their own material by now.
    void add_variants(const std::vector<int>& materials, std::size_t first) {
        if (variants_.empty() && !materials.empty())
            variants_.resize(materials.size(),
                             {mesh_.materials.begin(), mesh_.materials.begin() + std::ptrdiff_t(first)});
        for (std::size_t i = 0; i < variants_.size(); ++i) {
            const bool is_other = i < materials.size() && materials[i] >= 0;
            variants_[i].resize(mesh_.triangles.size(),
                                is_other ? static_cast<uint>(materials[i]) : mesh_.materials.back());
        }
    }

    void note_what_is_ignored(const Primitive& primitive) {
        if (attribute_of(primitive, "COLOR_0") >= 0) file_.warn("vertex colours (COLOR_0) are ignored");
    }

    GltfFile& file_;
    const tinygltf::Mesh& source_;
    std::string name_;
    uint default_material_;
    bool has_normals_ = false, has_uvs_ = false, has_tangents_ = true;
    // Primitives often share one vertex buffer and differ in their indices; it is appended once.
    std::map<std::vector<int>, Part> parts_;
    MotionLayout layout_;
    Mesh mesh_;
    VertexMotion motion_;
    std::vector<std::vector<uint>> variants_;
};

}  // namespace

GltfMesh read_gltf_mesh(GltfFile& file, std::size_t index, uint default_material, bool is_skinned) {
    return MeshReader(file, index, default_material, is_skinned).read();
}

}  // namespace twinray
