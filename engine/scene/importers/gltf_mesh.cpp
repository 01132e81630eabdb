#include "engine/scene/importers/gltf_parts.h"

#include "engine/scene/mesh.h"

namespace twinray {
namespace {

using tinygltf::Primitive;

// The arrays of a whole mesh.
struct VertexLayout {
    bool normals = false, tangents = false, uvs = false, second_uvs = false, colors = false;
    MotionLayout motion;
};

bool has_alpha(const GltfFile& file, int accessor) {
    const auto& accessors = file.model.accessors;
    return std::size_t(accessor) < accessors.size() && accessors[std::size_t(accessor)].type == TINYGLTF_TYPE_VEC4;
}

// Colours have 3 or 4 components and are clamped as glTF 2.0 (3.7.2.1) says.
std::vector<vec4> read_colors(GltfFile& file, const Primitive& primitive, std::size_t vertex_count,
                              const std::string& object) {
    std::vector<vec4> colors(vertex_count, vec4(1));
    const int accessor = attribute_of(primitive.attributes, "COLOR_0");
    if (accessor < 0) return colors;
    const int components = has_alpha(file, accessor) ? 4 : 3;
    const std::vector<float> values = read_floats(file, accessor, components, object + " COLOR_0");
    const std::size_t width = std::size_t(components);
    check_element_count(file, values.size() / width, vertex_count, object, "COLOR_0");
    std::size_t unknown = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        unknown += std::isnan(values[i]);
        colors[i / width][int(i % width)] = std::isnan(values[i]) ? 1 : std::clamp(values[i], 0.0f, 1.0f);
    }
    if (unknown) file.warn(text(object, " COLOR_0: ", unknown, " numbers are NaN, and taken as 1"));
    return colors;
}

// Returns all accessors that the vertices are made from.
std::vector<int> accessors_of(const Primitive& primitive) {
    std::vector<int> accessors;
    for (const char* name : {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"})
        accessors.push_back(attribute_of(primitive.attributes, name));
    for (const auto& [name, accessor] : primitive.attributes)
        if (name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_")) accessors.push_back(accessor);
    for (const auto& target : primitive.targets)
        for (const auto& [name, accessor] : target) accessors.push_back(accessor);
    return accessors;
}

// Returns the arrays that the mesh has. is_skinned: whether a node with a skin shows the mesh.
VertexLayout vertex_layout(const GltfFile& file, const std::vector<const Primitive*>& primitives,
                           const std::string& object, bool is_skinned) {
    VertexLayout layout;
    layout.tangents = !primitives.empty();
    for (const Primitive* primitive : primitives) {
        const auto has = [&](const char* name) { return attribute_of(primitive->attributes, name) >= 0; };
        layout.normals |= has("NORMAL");
        layout.uvs |= has("TEXCOORD_0");
        layout.second_uvs |= has("TEXCOORD_1");
        layout.colors |= has("COLOR_0");
        // Shading derives tangents if a mesh has none, so all or none is right and a mixture is not.
        layout.tangents &= has("TANGENT") && has("NORMAL");
    }
    layout.motion = motion_layout(file, primitives, object, is_skinned);
    layout.motion.normals &= layout.normals;
    layout.motion.tangents &= layout.tangents;
    return layout;
}

// Returns the vertices of one primitive: their attributes and motion data. Missing parts of the layout are 0, missing
// colours white, and missing second texture coordinates equal the first.
GltfMesh read_gltf_vertices(GltfFile& file, const Primitive& primitive, const VertexLayout& layout,
                            const std::string& object) {
    GltfMesh vertices;
    Mesh& v = vertices.mesh;
    v.positions = read_vectors<3>(file, attribute_of(primitive.attributes, "POSITION"), object + " POSITION");
    const std::size_t count = v.positions.size();
    const char* second = attribute_of(primitive.attributes, "TEXCOORD_1") < 0 ? "TEXCOORD_0" : "TEXCOORD_1";
    if (layout.normals) v.normals = read_attribute<3>(file, primitive.attributes, "NORMAL", count, object);
    if (layout.tangents) v.tangents = read_attribute<4>(file, primitive.attributes, "TANGENT", count, object);
    if (layout.uvs) v.uvs = read_attribute<2>(file, primitive.attributes, "TEXCOORD_0", count, object);
    if (layout.second_uvs) v.second_uvs = read_attribute<2>(file, primitive.attributes, second, count, object);
    if (layout.colors) v.colors = read_colors(file, primitive, count, object);
    vertices.motion = read_gltf_motion(file, primitive, layout.motion, count, object);
    return vertices;
}

GltfMesh picked_vertices(const GltfMesh& all, const std::vector<uint>& vertices) {
    GltfMesh result{{}, picked(all.motion, vertices), {}};
    for_each_vertex_array([&](auto& some, const auto& values) { some = picked(values, 1, vertices); }, result.mesh,
                          all.mesh);
    return result;
}

bool makes_triangles(const Primitive& primitive) {
    return attribute_of(primitive.attributes, "POSITION") >= 0 &&
           (primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
            primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN);
}

// Strips and fans as glTF 2.0 (3.7.2.1) defines their winding.
std::vector<uvec3> assemble(const std::vector<uint>& indices, int mode) {
    std::vector<uvec3> triangles;
    const std::size_t step = mode == TINYGLTF_MODE_TRIANGLES ? 3 : 1;
    for (std::size_t i = 0; i + 2 < indices.size(); i += step) {
        const uint a = indices[i], b = indices[i + 1], c = indices[i + 2];
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
            triangles.emplace_back(b, c, indices[0]);
        else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1)
            triangles.emplace_back(a, c, b);
        else
            triangles.emplace_back(a, b, c);
    }
    return triangles;
}

// Puts the primitives of one mesh together.
class MeshReader {
  public:
    MeshReader(GltfFile& file, std::size_t index, const std::vector<Material>& materials, bool is_skinned)
        : file_(file),
          source_(file.model.meshes[index]),
          name_(gltf_name("mesh", index, source_.name)),
          materials_(materials) {
        mesh_.name = source_.name.empty() ? text("mesh ", index) : source_.name;
        std::vector<const Primitive*> shown;
        for (const Primitive& primitive : source_.primitives)
            if (makes_triangles(primitive)) shown.push_back(&primitive);
        layout_ = vertex_layout(file, shown, name_, is_skinned);
    }

    GltfMesh read() {
        std::size_t skipped = 0;
        for (std::size_t i = 0; i < source_.primitives.size(); ++i) {
            look_for_interruption();
            if (makes_triangles(source_.primitives[i]))
                add(source_.primitives[i], text(name_, " primitive ", i));
            else
                ++skipped;
        }
        if (skipped)
            file_.warn(text(name_, ": skipped ", skipped, " primitives of points, lines or without positions"));
        return {std::move(mesh_), std::move(motion_), std::move(variants_)};
    }

  private:
    // The position of a primitive's vertices in mesh_.
    struct Part {
        uint base = 0;
        std::size_t count = 0;
    };

    uint append_vertices(const GltfMesh& vertices) {
        const std::size_t base = mesh_.positions.size();
        if (base + vertices.mesh.positions.size() > UINT32_MAX) file_.fail(name_, ": has over 2^32 vertices");
        for_each_vertex_array([](auto& all, const auto& part) { append(all, part); }, mesh_, vertices.mesh);
        append(motion_, vertices.motion);
        return static_cast<uint>(base);
    }

    std::vector<uvec3> read_triangles(const Primitive& primitive, std::size_t vertex_count, const std::string& object) {
        std::vector<uint> indices;
        if (primitive.indices >= 0)
            indices = read_indices(file_, primitive.indices, object + " indices");
        else
            for (uint i = 0; i < vertex_count; ++i) indices.push_back(i);
        for (std::size_t i = 0; i < indices.size(); ++i)
            if (indices[i] >= vertex_count)
                file_.fail(object, ": index ", indices[i], " at position ", i, " is out of range; POSITION has ",
                           vertex_count, " elements");
        if (primitive.mode == TINYGLTF_MODE_TRIANGLES && indices.size() % 3 != 0)
            file_.warn(text(object, ": ignored ", indices.size() % 3, " vertices after the last whole triangle"));
        return assemble(indices, primitive.mode);
    }

    void add(const Primitive& primitive, const std::string& object) {
        note_what_is_ignored(primitive);
        note_missing_uvs(primitive, object);
        if (layout_.normals && attribute_of(primitive.attributes, "NORMAL") < 0) return add_flat(primitive, object);
        const Part part = shared_part(primitive, object);
        add_triangles(read_triangles(primitive, part.count, object), part.base, primitive, object);
    }

    Part shared_part(const Primitive& primitive, const std::string& object) {
        const std::vector<int> key = accessors_of(primitive);
        if (const auto found = parts_.find(key); found != parts_.end()) return found->second;
        const GltfMesh vertices = read_gltf_vertices(file_, primitive, layout_, object);
        return parts_[key] = {append_vertices(vertices), vertices.mesh.positions.size()};
    }

    // A flat face needs vertices of its own.
    void add_flat(const Primitive& primitive, const std::string& object) {
        const GltfMesh shared = read_gltf_vertices(file_, primitive, layout_, object);
        std::vector<uint> indices;
        for (const uvec3& t : read_triangles(primitive, shared.mesh.positions.size(), object))
            indices.insert(indices.end(), {t.x, t.y, t.z});
        GltfMesh own = picked_vertices(shared, indices);
        std::vector<uvec3> own_triangles;
        const std::vector<vec3>& positions = own.mesh.positions;
        for (uint i = 0; i + 2 < positions.size(); i += 3) {
            const dvec3 a(positions[i]), b(positions[i + 1]), c(positions[i + 2]);
            const dvec3 normal = unit_or_zero(cross(b - a, c - a));
            std::fill_n(&own.mesh.normals[i], 3, normal == dvec3(0) ? vec3(0, 0, 1) : vec3(normal));
            own_triangles.emplace_back(i, i + 1, i + 2);
        }
        add_triangles(own_triangles, append_vertices(own), primitive, object);
    }

    void add_triangles(const std::vector<uvec3>& triangles, uint base, const Primitive& primitive,
                       const std::string& object) {
        if (primitive.material >= 0) file_.entry(materials_, primitive.material, name_, "material");
        for (const uvec3& triangle : triangles) mesh_.triangles.push_back(triangle + base);
        const std::size_t before = mesh_.materials.size();
        const uint material = static_cast<uint>(primitive.material < 0 ? materials_.size() : primitive.material);
        mesh_.materials.resize(mesh_.triangles.size(), material);
        add_variants(read_variant_materials(file_, primitive, object), before);
    }

    // Adds variants for the triangles from the first on, which have their own material by now.
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
        if (attribute_of(primitive.attributes, "COLOR_1") >= 0)
            file_.warn("vertex colours other than COLOR_0 are ignored");
        for (const auto& target : primitive.targets)
            for (const auto& [name, accessor] : target)
                if (name.starts_with("COLOR_") || name.starts_with("TEXCOORD_"))
                    file_.warn("colours and texture coordinates of morph targets are ignored");
    }

    void note_missing_uvs(const Primitive& primitive, const std::string& object) {
        if (primitive.material < 0 || std::size_t(primitive.material) >= materials_.size()) return;
        const Material& material = materials_[std::size_t(primitive.material)];
        for (const Texture* texture : textures_of(material)) {
            const std::string wanted = text("TEXCOORD_", texture->uv_set);
            if (texture->image < 0 || attribute_of(primitive.attributes, wanted) >= 0) continue;
            const bool has_first = attribute_of(primitive.attributes, "TEXCOORD_0") >= 0;
            file_.warn(text(object, ": lacks the ", wanted, " of material '", material.name, "', whose textures show ",
                            has_first ? "by TEXCOORD_0" : "one texel"));
        }
    }

    GltfFile& file_;
    const tinygltf::Mesh& source_;
    std::string name_;
    const std::vector<Material>& materials_;
    // Primitives often share one vertex buffer and differ in their indices; it is appended once.
    std::map<std::vector<int>, Part> parts_;
    VertexLayout layout_;
    Mesh mesh_;
    VertexMotion motion_;
    std::vector<std::vector<uint>> variants_;
};

constexpr const char* variants_extension = "KHR_materials_variants";

// Returns the entries of a list in the extension; none if there is no such list.
std::vector<tinygltf::Value> entries_of(const tinygltf::ExtensionMap& extensions, const char* list) {
    const tinygltf::Value* extension = find_extension(extensions, variants_extension);
    const tinygltf::Value* member = extension ? find_member(*extension, list) : nullptr;
    return member && member->IsArray() ? member->Get<tinygltf::Value::Array>() : std::vector<tinygltf::Value>();
}

}  // namespace

int attribute_of(const GltfAttributes& attributes, const std::string& name) {
    const auto found = attributes.find(name);
    return found == attributes.end() ? -1 : found->second;
}

void check_element_count(const GltfFile& file, std::size_t count, std::size_t vertex_count, const std::string& object,
                         std::string_view name) {
    if (count != vertex_count)
        file.fail(object, ": ", name, " has ", count, " elements, but POSITION has ", vertex_count);
}

GltfMesh read_gltf_mesh(GltfFile& file, std::size_t index, const std::vector<Material>& materials, bool is_skinned) {
    return MeshReader(file, index, materials, is_skinned).read();
}

std::vector<std::string> read_variant_names(const GltfFile& file) {
    std::vector<std::string> names;
    for (const tinygltf::Value& variant : entries_of(file.model.extensions, "variants")) {
        const tinygltf::Value* name = find_member(variant, "name");
        names.push_back(name && name->IsString() ? name->Get<std::string>() : text("variant ", names.size()));
    }
    return names;
}

std::vector<int> read_variant_materials(const GltfFile& file, const tinygltf::Primitive& primitive,
                                        const std::string& object) {
    const std::vector<tinygltf::Value> mappings = entries_of(primitive.extensions, "mappings");
    if (mappings.empty()) return {};
    const std::size_t count = entries_of(file.model.extensions, "variants").size();
    std::vector<int> materials(count, -1);
    for (const tinygltf::Value& mapping : mappings) {
        const int material = index_of(mapping, "material");
        if (material < 0 || std::size_t(material) >= file.model.materials.size())
            file.fail(object, ": ", variants_extension, " names material ", material, "; the file has ",
                      file.model.materials.size());
        for (const double variant : numbers_of(mapping, "variants")) {
            if (!(variant >= 0) || !(variant < static_cast<double>(count)))
                file.fail(object, ": ", variants_extension, " names variant ", variant, "; the file has ", count);
            materials[static_cast<std::size_t>(variant)] = material;
        }
    }
    return materials;
}

}  // namespace twinray
