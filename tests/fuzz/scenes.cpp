// Files of scenes, pictures of textures, environment maps, and what users of them rely on.
#include <algorithm>
#include <string_view>

#include "tests/fuzz/targets.h"
#include <twinray/scene.h>

namespace twinray::fuzz {
namespace {

void check(const Mesh& mesh, std::size_t material_count) {
    require(!mesh.triangles.empty(), "a mesh has triangles");
    check_indices(mesh);
    for (const std::size_t size :
         {mesh.normals.size(), mesh.tangents.size(), mesh.uvs.size(), mesh.second_uvs.size(), mesh.colors.size()})
        require(size == 0 || size == mesh.positions.size(), "an attribute has one entry a vertex");
    require(mesh.materials.size() == mesh.triangles.size(), "each triangle has a material");
    for (const uint material : mesh.materials) require(material < material_count, "a triangle's material exists");
}

void check(const Image& image) {
    const std::size_t numbers = std::size_t(4) * image.width * image.height;
    require(image.rgba.size() == (image.rgba16.empty() ? numbers : 0), "an image has four numbers a pixel");
    require(image.rgba16.empty() || image.rgba16.size() == numbers, "an image of 16 bits has four numbers a pixel");
}

void check(const Scene& scene) {
    require(!scene.materials.empty(), "a scene has materials");
    for (const Mesh& mesh : scene.meshes) check(mesh, scene.materials.size());
    for (const Instance& instance : scene.instances) {
        require(instance.mesh < scene.meshes.size(), "an instance's mesh exists");
        require(fault_of(instance.transform).empty(), "an instance can be placed");
        require(!instance.material || *instance.material < scene.materials.size(), "an instance's material exists");
    }
    for (const Material& material : scene.materials)
        for (const Texture* texture : textures_of(material))
            require(texture->image >= -1 && texture->image < static_cast<int>(scene.images.size()),
                    "a texture's image exists");
    for (const Image& image : scene.images) check(image);
    for (const MaterialVariant& variant : scene.variants)
        for (const MaterialVariant::Part& part : variant.parts)
            require(
                part.mesh < scene.meshes.size() && part.materials.size() == scene.meshes[part.mesh].triangles.size(),
                "a variant has a material for each triangle of a mesh");
}

// Plays all animations, at their first and last moment and between.
void play(Scene& scene) {
    const Rig& rig = *scene.rig;
    pose_scene(scene, rest_pose(rig));
    const std::vector<AnimationInfo> animations = animations_of(rig);
    for (std::size_t i = 0; i < animations.size(); ++i) {
        const TimeRange range = animations[i].range;
        for (const double seconds : {range.begin, (range.begin + range.end) / 2, range.end})
            if (is_taken([&] { pose_scene(scene, pose_at(rig, i, seconds)); }))
                require(instance_transforms(rig, rest_pose(rig)).size() == scene.instances.size(),
                        "a rig has a transform for each instance");
    }
    for (const uint mesh : deformed_meshes(rig)) require(mesh < scene.meshes.size(), "a mesh that deforms exists");
}

// Ends the process unless the scene that load_scene() took is whole: each index names something, each array has its
// length, and all that moves can be posed.
void load_whole_scene(const std::filesystem::path& file) {
    is_taken([&] {
        Scene scene = load_scene(file);
        check(scene);
        bounds_of(scene);
        for (const MaterialVariant& variant : scene.variants) apply_variant(scene, variant.name);
        if (scene.rig) play(scene);
    });
}

void load_map(const std::filesystem::path& file) {
    is_taken([&] {
        const HdrImage image = load_hdr_image(file);
        require(image.rgb.size() == std::size_t(image.width) * image.height, "an image has a colour a pixel");
        for (const vec3& pixel : image.rgb)
            for (const float value : {pixel.x, pixel.y, pixel.z})
                require(value >= 0 && value < INFINITY, "a map can be sampled as light");
    });
}

}  // namespace

void hdr(Input input) { load_map(file_of(input, "input.hdr")); }
void exr(Input input) { load_map(file_of(input, "input.exr")); }

void image(Input input) {
    is_taken([&] {
        const Image image = decode_image(input, "input");
        const std::size_t numbers = std::size_t(4) * image.width * image.height;
        require(numbers > 0 && std::max(image.rgba.size(), image.rgba16.size()) == numbers,
                "an image has four numbers a pixel");
    });
}

// Reads both .gltf and .glb, which are told apart by their content, whatever the name.
void gltf(Input input) { load_whole_scene(file_of(input, "input.gltf")); }
void ply(Input input) { load_whole_scene(file_of(input, "input.ply")); }
void stl(Input input) { load_whole_scene(file_of(input, "input.stl")); }

// The text after the first line "#mtl" is the library of materials, "input.mtl".
void obj(Input input) {
    constexpr std::string_view border = "\n#mtl\n";
    const auto found = std::search(input.begin(), input.end(), border.begin(), border.end());
    const auto size = static_cast<std::size_t>(found - input.begin());
    file_of(input.subspan(found == input.end() ? size : size + border.size()), "input.mtl");
    load_whole_scene(file_of(input.first(size), "input.obj"));
}

}  // namespace twinray::fuzz
