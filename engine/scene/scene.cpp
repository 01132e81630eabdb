#include <algorithm>

#include "engine/scene/rig.h"
#include "engine/core/error.h"
#include "engine/core/files.h"
#include "engine/scene/importers/importers.h"
#include "twinray/glsl/vector_math.h"
#include "engine/scene/mesh.h"

namespace twinray {
namespace {

Scene read_by_suffix(const std::filesystem::path& file, const std::optional<dvec3>& origin) {
    const std::string suffix = lower_suffix(file);
    if (suffix == ".gltf" || suffix == ".glb") return import_gltf(file, origin);
    const std::string inner = suffix == ".gz" ? lower_suffix(file.stem()) : suffix;
    if (inner == ".ply") return import_ply(file, origin);
    if (inner == ".obj") return import_obj(file, origin);
    if (inner == ".stl") return import_stl(file, origin);
    fail("'", file.string(), "': unknown suffix '", suffix == ".gz" ? inner + suffix : suffix,
         "'; scenes are .gltf, .glb, .obj, .ply or .stl, the last three also with .gz");
}

// Readers give triangles without a material the index after the last one.
void add_default_material(Scene& scene) {
    const uint index = static_cast<uint>(scene.materials.size());
    for (const Mesh& mesh : scene.meshes)
        if (std::ranges::find(mesh.materials, index) != mesh.materials.end()) {
            scene.materials.push_back({.name = "default"});
            return;
        }
}

// Completes a scene as every reader must leave it.
void complete(Scene& scene, const std::filesystem::path& file) {
    const bool has_hidden = scene.rig && !scene.rig->hidden.empty();
    if (scene.instances.empty() && !has_hidden)
        fail("'", file.string(), "': holds no triangles to place",
             scene.warnings.empty() ? std::string() : text(" (", scene.warnings.front(), ")"));
    if (scene.instances.empty()) scene.warnings.push_back("at rest nothing is shown: all has a scale of 0");
    add_default_material(scene);
    std::ranges::stable_sort(scene.instances, {}, &Instance::mesh);
    for (const Mesh& mesh : scene.meshes) {
        if (const std::size_t count = count_non_finite_triangles(mesh))
            scene.warnings.push_back(text("mesh '", mesh.name, "': ", count, " of ", mesh.triangles.size(),
                                          " triangles have a NaN or infinite coordinate and stay inactive"));
        if (const std::size_t count = count_undirected_normals(mesh))
            scene.warnings.push_back(text("mesh '", mesh.name, "': ", count, " of ", mesh.normals.size(),
                                          " normals are 0, NaN or infinite; triangles show their own there"));
    }
}

}  // namespace

std::array<const Texture*, 13> textures_of(const Material& material) {
    return {
        &material.base_color_texture,       &material.metallic_roughness_texture, &material.emission_texture,
        &material.normal_texture,           &material.transmission_texture,       &material.specular_texture,
        &material.specular_color_texture,   &material.clearcoat_texture,          &material.clearcoat_roughness_texture,
        &material.clearcoat_normal_texture, &material.sheen_color_texture,        &material.sheen_roughness_texture,
        &material.anisotropy_texture};
}

Scene load_scene(const std::filesystem::path& file, const std::optional<dvec3>& origin) {
    try {
        Scene scene = read_by_suffix(file, origin);
        complete(scene, file);
        return scene;
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {  // out of memory on a size that the file made up
        fail("'", file.string(), "': cannot be loaded (", e.what(), ")");
    }
}

Bounds bounds_of(const Scene& scene) {
    std::vector<Bounds> mesh_bounds;
    for (const Mesh& mesh : scene.meshes) mesh_bounds.push_back(bounds_of(MeshView(mesh)));
    std::vector<PlacedMesh> placed;
    for (const Instance& instance : scene.instances)
        placed.push_back({scene.meshes[instance.mesh], mesh_bounds[instance.mesh], instance.transform});
    return bounds_of(placed);
}

Mesh joined(const Scene& scene, std::string name) {
    Mesh mesh;
    mesh.name = std::move(name);
    for (const Instance& instance : scene.instances) {
        const Mesh& part = scene.meshes[instance.mesh];
        const uint first = static_cast<uint>(mesh.positions.size());
        for (const vec3& position : part.positions)
            mesh.positions.push_back(transform_point(instance.transform, position));
        const bool is_mirrored = determinant(instance.transform) < 0;
        for (const uvec3& triangle : part.triangles)
            mesh.triangles.push_back((is_mirrored ? uvec3(triangle.x, triangle.z, triangle.y) : triangle) + first);
    }
    return mesh;
}

void apply_variant(Scene& scene, const std::string& name) {
    const auto variant = std::ranges::find(scene.variants, name, &MaterialVariant::name);
    if (variant == scene.variants.end()) {
        std::string names;
        for (const MaterialVariant& other : scene.variants) names += (names.empty() ? "'" : ", '") + other.name + "'";
        fail("variant '", name, "' does not exist; the scene has ", names.empty() ? "none" : names);
    }
    for (const MaterialVariant::Part& part : variant->parts) scene.meshes[part.mesh].materials = part.materials;
}

std::size_t count_triangles(const Scene& scene) {
    std::size_t count = 0;
    for (const Instance& instance : scene.instances) count += scene.meshes[instance.mesh].triangles.size();
    return count;
}

}  // namespace twinray
