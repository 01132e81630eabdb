#include "engine/scene/glb.h"

#include <algorithm>
#include <map>

#include <tiny_gltf.h>

#include "engine/core/error.h"
#include "engine/core/ray.h"
#include "engine/core/files.h"
#include "twinray/glsl/cpp.h"

namespace twinray {
namespace {

using Channels = std::array<std::uint16_t, 4>;
using ChannelTable = std::array<std::uint16_t, 256>;

// Returns a table from sRGB to linear light in 16 bits.
ChannelTable linear_table() {
    ChannelTable table{};
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = static_cast<std::uint16_t>(std::lround(linear_of_srgb(static_cast<float>(i) / 255) * 65535));
    return table;
}

// Returns whether glTF nodes can express it: a rotation and scales along the axes, so columns that are perpendicular,
// apart from rounding.
bool is_decomposable(const Transform& transform) {
    const auto column = [&](int i) { return dvec3(transform.rows[0][i], transform.rows[1][i], transform.rows[2][i]); };
    const auto perpendicular = [&](int i, int j) {
        return std::abs(dot(column(i), column(j))) <= 0x1p-20 * length(column(i)) * length(column(j));
    };
    return perpendicular(0, 1) && perpendicular(1, 2) && perpendicular(0, 2);
}

class GlbModel {
  public:
    explicit GlbModel(const Scene& scene) : scene_(scene) {
        model_.asset.version = "2.0";
        model_.asset.generator = "twinray";
        model_.buffers.emplace_back();
        tinygltf::Material material;
        material.doubleSided = true;
        material.pbrMetallicRoughness.metallicFactor = 0;
        model_.materials.push_back(std::move(material));
        model_.scenes.emplace_back();
        model_.defaultScene = 0;
    }

    void add(const Instance& instance, std::span<const Rgb> colors) {
        const bool is_node = is_decomposable(instance.transform);
        const int mesh = mesh_of(instance, colors, is_node);
        if (mesh < 0) return;
        tinygltf::Node node;
        node.name = instance.name;
        node.mesh = mesh;
        if (is_node && instance.transform != Transform{}) {
            const auto& rows = instance.transform.rows;
            for (int i = 0; i < 4; ++i)
                for (const float entry : {rows[0][i], rows[1][i], rows[2][i], i == 3 ? 1.0f : 0.0f})
                    node.matrix.push_back(static_cast<double>(entry));
        }
        add_root(std::move(node));
    }

    // Marks are unlit and in coordinates about the scene's origin.
    void add(std::span<const GlbMarks::Vertex> marks, int mode, const char* name) {
        std::vector<vec3> positions;
        std::vector<Channels> channels;
        for (const GlbMarks::Vertex& mark : marks) {
            positions.emplace_back(mark.position);
            channels.push_back(channels_of(mark.color));
        }
        if (positions.empty()) return;
        if (unlit_ < 0) unlit_ = add_unlit();
        tinygltf::Node node;
        node.name = name;
        node.mesh = add_mesh(name, {mode, unlit_, positions, channels});
        add_root(std::move(node));
    }

    std::size_t bytes() const { return model_.buffers[0].data.size(); }
    // glTF allows neither buffers nor scenes without contents.
    tinygltf::Model finished() && {
        if (model_.nodes.empty()) {
            model_.buffers.clear();
            model_.scenes.clear();
            model_.defaultScene = -1;
        } else if (const dvec3& origin = scene_.origin; origin != dvec3(0)) {
            tinygltf::Node root;
            root.name = "local origin";
            root.translation = {origin.x, origin.y, origin.z};
            root.children = std::exchange(model_.scenes[0].nodes, {});
            add_root(std::move(root));
        }
        return std::move(model_);
    }

  private:
    void add_root(tinygltf::Node&& node) {
        model_.scenes[0].nodes.push_back(static_cast<int>(model_.nodes.size()));
        model_.nodes.push_back(std::move(node));
    }

    // Returns -1 if nothing of it can be written.
    int mesh_of(const Instance& instance, std::span<const Rgb> colors, bool is_node) {
        const Transform to_world = is_node ? Transform{} : instance.transform;
        if (!is_node) return make_mesh(scene_.meshes[instance.mesh], to_world, colors);
        const auto [found, is_new] = meshes_.try_emplace({instance.mesh, {colors.begin(), colors.end()}}, -1);
        if (is_new) found->second = make_mesh(scene_.meshes[instance.mesh], to_world, colors);
        return found->second;
    }

    int make_mesh(const Mesh& mesh, const Transform& to_world, std::span<const Rgb> colors) {
        std::vector<vec3> positions;
        std::vector<Channels> channels;
        const bool is_mirrored = determinant(to_world) < 0;
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            std::array<vec3, 3> vertices;
            for (int k = 0; k < 3; ++k)
                vertices[static_cast<std::size_t>(k)] = transform_point(to_world, mesh.positions[mesh.triangles[i][k]]);
            if (!std::all_of(vertices.begin(), vertices.end(), [](vec3 p) { return is_finite(p); })) continue;
            if (is_mirrored) std::swap(vertices[1], vertices[2]);  // fronts stay fronts
            positions.insert(positions.end(), vertices.begin(), vertices.end());
            channels.insert(channels.end(), 3, channels_of(colors[i]));
        }
        return positions.empty() ? -1 : add_mesh(mesh.name, {TINYGLTF_MODE_TRIANGLES, 0, positions, channels});
    }

    Channels channels_of(Rgb color) const { return {table_[color.r], table_[color.g], table_[color.b], 65535}; }

    int add_unlit() {
        const char* unlit = "KHR_materials_unlit";
        tinygltf::Material material;
        material.extensions[unlit] = tinygltf::Value(tinygltf::Value::Object{});
        model_.extensionsUsed.emplace_back(unlit);
        model_.materials.push_back(std::move(material));
        return static_cast<int>(model_.materials.size()) - 1;
    }

    struct Vertices {
        int mode, material;
        const std::vector<vec3>& positions;
        const std::vector<Channels>& channels;
    };
    int add_mesh(const std::string& name, const Vertices& vertices) {
        tinygltf::Primitive primitive;
        primitive.mode = vertices.mode;
        primitive.material = vertices.material;
        primitive.attributes["POSITION"] = add_positions(vertices.positions);
        primitive.attributes["COLOR_0"] =
            add_accessor(std::as_bytes(std::span(vertices.channels)), vertices.channels.size(),
                         TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4);
        model_.accessors.back().normalized = true;
        tinygltf::Mesh written;
        written.name = name;
        written.primitives.push_back(std::move(primitive));
        model_.meshes.push_back(std::move(written));
        return static_cast<int>(model_.meshes.size()) - 1;
    }

    int add_positions(const std::vector<vec3>& positions) {
        const int accessor = add_accessor(std::as_bytes(std::span(positions)), positions.size(),
                                          TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
        Bounds bounds;
        for (const vec3& position : positions) bounds.include(position);
        for (int i = 0; i < 3; ++i) {
            model_.accessors.back().minValues.push_back(static_cast<double>(bounds.lo[i]));
            model_.accessors.back().maxValues.push_back(static_cast<double>(bounds.hi[i]));
        }
        return accessor;
    }

    int add_accessor(std::span<const std::byte> bytes, std::size_t count, int component_type, int type) {
        std::vector<unsigned char>& data = model_.buffers[0].data;
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = data.size();
        view.byteLength = bytes.size();
        view.target = TINYGLTF_TARGET_ARRAY_BUFFER;
        const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
        data.insert(data.end(), first, first + bytes.size());
        tinygltf::Accessor accessor;
        accessor.bufferView = static_cast<int>(model_.bufferViews.size());
        accessor.componentType = component_type;
        accessor.type = type;
        accessor.count = count;
        model_.bufferViews.push_back(std::move(view));
        model_.accessors.push_back(std::move(accessor));
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    const Scene& scene_;
    const ChannelTable table_ = linear_table();
    tinygltf::Model model_;
    int unlit_ = -1;
    std::map<std::pair<uint, std::vector<Rgb>>, int> meshes_;  // by mesh and colours
};

}  // namespace

void write_glb(const std::filesystem::path& file, const Scene& scene, std::span<const Rgb> colors,
               const GlbMarks& marks) {
    constexpr std::size_t most_bytes = UINT32_MAX, bytes_a_face = 3 * (sizeof(vec3) + 8), bytes_for_json = 1 << 28;
    const std::size_t count = count_triangles(scene);
    if (colors.size() != count) fail("'", file.string(), "': ", colors.size(), " colours for ", count, " faces");
    GlbModel maker(scene);
    std::size_t first = 0;
    for (const Instance& instance : scene.instances) {
        const std::size_t faces = scene.meshes[instance.mesh].triangles.size();
        maker.add(instance, colors.subspan(first, faces));
        first += faces;
    }
    maker.add(marks.lines, TINYGLTF_MODE_LINE, "lines");
    maker.add(marks.points, TINYGLTF_MODE_POINTS, "points");
    if (maker.bytes() > most_bytes - bytes_for_json)
        fail("'", file.string(), "': ", count, " faces of ", bytes_a_face, " bytes are more than the 4 GiB of a .glb");
    const tinygltf::Model model = std::move(maker).finished();
    std::ostringstream out(std::ios::binary);
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, out, false, true))
        fail("'", file.string(), "': the scene cannot be written as glTF");
    write_file(file, out.str());
}

}  // namespace twinray
