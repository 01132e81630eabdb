// SPDX-License-Identifier: MIT
// Scenes: the meshes, materials, images, lights and cameras of a file, their animation, and their way into an
// accelerator and kernels. Distances are in the file's unit; colours are linear unless they are called sRGB.
#pragma once

#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <twinray/geometry.h>

#include <twinray/commands.h>

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "twinray/glsl/textures.h"
#include "twinray/glsl/cpp_end.h"

class AbstractAccel;
struct AccelHandle;

// ---- What a scene holds ---------------------------------------------------------------------------------------------

// RGBA in 8 or 16 bits, row 0 first (glTF's v = 0). Its use decides: sRGB for base colour and emission, else linear.
struct Image {
    std::string name;
    uint width = 0;
    uint height = 0;
    std::vector<std::uint8_t> rgba;
    std::vector<std::uint16_t> rgba16 = {};  // used instead for files with 16 bits per channel
    bool is_placeholder = false;             // a checkerboard in place of an image that could not be decoded
};

// How coordinates beyond an image's edges are treated.
enum class Wrap : std::uint8_t { repeat, clamp_to_edge, mirrored_repeat };
// How magnified texels are filtered.
enum class Filter : std::uint8_t { linear, nearest };

// An image with its sampling: uv' = rotation/scale/offset of KHR_texture_transform applied to the mesh's uv.
struct Texture {
    std::int32_t image = -1;  // index into Scene::images, -1 = none
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    Filter filter = Filter::linear;
    uint uv_set = 0;  // the mesh's set, 0 or 1: see Mesh::uv_set
    // uv' = (row0 . (u, v, 1), row1 . (u, v, 1))
    vec3 uv_row0 = vec3(1, 0, 0);
    vec3 uv_row1 = vec3(0, 1, 0);
};

// The modes of glTF.
enum class AlphaMode : std::uint8_t { opaque, mask, blend };

// glTF 2.0 metallic-roughness material with KHR_materials_{anisotropy, clearcoat, emissive_strength, ior, sheen,
// specular, transmission, unlit, volume}. Roughness is perceptual throughout.
struct Material {
    std::string name;
    vec4 base_color = vec4(1);  // linear
    float metallic = 1;
    float roughness = 1;      // perceptual, as glTF; alpha = roughness^2
    vec3 emission = vec3(0);  // linear, emissive_strength multiplied in
    float transmission = 0;
    float ior = 1.5f;
    float specular = 1;             // weight of the dielectric reflection
    vec3 specular_color = vec3(1);  // linear, the colour of its reflectance at normal incidence
    float clearcoat = 0;
    float clearcoat_roughness = 0;
    float clearcoat_normal_scale = 1;
    vec3 sheen_color = vec3(0);  // linear
    float sheen_roughness = 0;
    float anisotropy = 0;
    float anisotropy_rotation = 0;     // radians, from the tangent to the bitangent
    float thickness = 0;               // above 0: the surface bounds a volume that transmits, else it is a thin wall
    vec3 attenuation_color = vec3(1);  // linear: the remaining part of white light after attenuation_distance
    float attenuation_distance = INFINITY;
    float normal_scale = 1;
    float alpha_cutoff = 0.5f;
    AlphaMode alpha_mode = AlphaMode::opaque;
    bool double_sided = false;
    bool unlit = false;
    Texture base_color_texture = {}, metallic_roughness_texture = {}, emission_texture = {}, normal_texture = {},
            transmission_texture = {}, specular_texture = {}, specular_color_texture = {}, clearcoat_texture = {},
            clearcoat_roughness_texture = {}, clearcoat_normal_texture = {}, sheen_color_texture = {},
            sheen_roughness_texture = {}, anisotropy_texture = {};
};

// Returns all textures of a material, including those without an image.
std::array<const Texture*, 13> textures_of(const Material& material);

// A mesh placed in the world.
struct Instance {
    std::string name;
    uint mesh = 0;  // index into Scene::meshes
    Transform transform;
    std::optional<uint> material = {};  // index into Scene::materials, replaces all of the mesh's
};

// KHR_materials_variants: alternative materials for the same triangles.
struct MaterialVariant {
    // The materials of one mesh.
    struct Part {
        uint mesh = 0;                // index into Scene::meshes
        std::vector<uint> materials;  // replace Mesh::materials
    };
    std::string name;
    std::vector<Part> parts;
};

// A camera that looks along -z of its frame, +y up (glTF).
struct Camera {
    std::string name;
    Transform camera_to_world;
    float vertical_fov = 0.8f;                      // radians; perspective
    std::optional<float> aspect;                    // width / height of its frame, if the file states one
    std::optional<float> orthographic_half_height;  // set: orthographic, in world units
};

// A light of KHR_lights_punctual.
struct Light {
    // The kinds of KHR_lights_punctual.
    enum class Kind : std::uint8_t { directional, point, spot };
    std::string name;
    Kind kind = Kind::point;
    vec3 color = vec3(1);  // linear; times intensity: lux (directional) or candela (point, spot)
    vec3 position = vec3(0);
    vec3 direction = vec3(0, 0, -1);  // unit, from the light
    float range = INFINITY;
    float inner_cone = 0;  // radians
    float outer_cone = 0.7853982f;
};

struct Rig;  // the moving parts of a scene: see "Animation" below

// A point of the file is `origin` plus a point of the scene. The origin is 0 except for files whose coordinates float32
// cannot hold, such as places far away in metres of UTM: see load_scene(). Rays of such a file are made in float64 and
// moved before they are rounded: ray.origin = vec3(point - scene.origin), and a hit is at scene.origin + dvec3(point).
struct Scene {
    dvec3 origin = dvec3(0);
    std::vector<Mesh> meshes;
    std::vector<Material> materials;  // never empty after load: an entry for meshes without a material is appended
    std::vector<Image> images;
    std::vector<Instance> instances;  // load_scene leaves them grouped by mesh, ascending
    std::vector<Camera> cameras;
    std::vector<Light> lights;
    std::vector<MaterialVariant> variants;
    std::shared_ptr<const Rig> rig;     // for files with animations; all else is in the rest pose. Null: nothing moves
    std::vector<std::string> warnings;  // one clear sentence for each thing that was skipped or replaced
};

// Loads .gltf, .glb (by tinygltf), .obj, .ply or .stl, the last three also with .gz, chosen by the suffix. Throws Error
// naming the file, the object and the limit for anything that cannot be rendered faithfully. `origin`: the scene's; not
// set: 0, unless float32 would round coordinates by more than a millionth of their extent, then a point near their
// middle with as round numbers as the extent allows; dvec3(0): the file's coordinates, rounded.
Scene load_scene(const std::filesystem::path& file, const std::optional<dvec3>& origin = {});

// Makes a box of [-1, 1]^3, open towards +z, with white walls, a red one on the left (-x), a green one on the right, a
// light under the ceiling, a metal box and a glass sphere; with a camera that sees all of it.
Scene cornell_box_scene();

// Makes 1200 glazed and golden beads in the spiral of a sunflower on a table, seen from above at an aspect of 16 : 9;
// it has no lights and is meant for a sky.
Scene sunflower_scene();

// Formats it as "500000 5400000 0", in as few digits as give the same float64.
std::string origin_text(const dvec3& origin);

// Returns the box of all instances' vertices in world space, as bounds_of(std::span<const PlacedMesh>) does.
Bounds bounds_of(const Scene& scene);

// Returns the number of triangles, counted once per instance.
std::size_t count_triangles(const Scene& scene);

// Returns all instances as one mesh in world space. Vertices that coincide in the scene coincide there if they are of
// one instance or transform. In mirrored instances, triangles' last two vertices change places: fronts stay fronts.
Mesh joined(const Scene& scene, std::string name);

// Gives the scene's meshes the materials of one of its variants. Throws Error naming the variants that it has.
void apply_variant(Scene& scene, const std::string& name);
// Flattens the mesh if the transform has no inverse because it loses one direction, and returns one that has.
std::optional<Transform> flatten(Mesh& mesh, const Transform& transform);

// Pushes every mesh with all its instances, so that Hit::instance_index is the index into scene.instances and
// Hit::custom_index is 1 + Instance::material, or 0 without one. Returns one handle per mesh that has instances. Throws
// Error unless scene.instances is grouped by mesh, as load_scene() leaves it.
std::vector<AccelHandle> push_scene(AbstractAccel& accel, const Scene& scene);

// Returns what an accelerator holds after a sync, with vertices and transforms as kernels have left them: a mesh for
// each handle, in the order of AbstractAccel::handles(), and instances in the order of Hit::instance_index. It has only
// positions and triangles; boxes become meshes without triangles. Waits, also for work recorded by sync(Commands&),
// which must be submitted. Throws Error for an instance whose transform is unusable.
Scene scene_of(AbstractAccel& accel);

// ---- Views of a scene -----------------------------------------------------------------------------------------------

// Makes a perspective camera. fov: vertical, in degrees. Throws Error if `at` equals `from` or lies along `up` from it,
// either way.
Camera look_camera(vec3 from, vec3 at, vec3 up, float fov);

// Makes a camera that sees the whole scene with a vertical field of view of 40 degrees; aspect: width / height of the
// picture. `direction` is the viewing direction in world space; without it, the camera looks from the front right and
// above, but turned to where surfaces face if they face one way, so that rooms are seen through their open side and
// pictures from the front. Up is +y, or -z if the camera looks straight up or down. `also`: points in world space that
// are seen too. Throws Error for a direction that is 0 or not finite.
Camera frame_scene(const Scene& scene, float aspect, const std::optional<vec3>& direction = {},
                   std::span<const dvec3> also = {});

// The view of a camera. The point (x, y) of its picture, from -1 to 1 to the right and upwards, shows what lies from
// `origin` along forward + right * x + up * y; in orthographic pictures from origin + right * x + up * y along forward.
struct ImagePlane {
    vec3 origin, right, up, forward;  // `forward` has length 1, and the three are perpendicular
    bool is_orthographic;
};
// Fits all of the camera's frame into the picture, whatever its aspect; the picture also shows the parts beside it.
ImagePlane image_plane(const Camera& camera, float aspect);

// Returns a ray whose `t` is the depth along `forward`.
Ray ray_through(const ImagePlane& plane, vec2 point);

// The result of project().
struct Projected {
    vec2 point;
    float depth;
};
// Projects a point in world space; returns nullopt for points behind the camera.
std::optional<Projected> project(const ImagePlane& plane, dvec3 position);

// ---- Images ---------------------------------------------------------------------------------------------------------

// Decodes PNG or JPEG; grey and RGB are widened to RGBA. Throws Error naming `object` and the apparent format of the
// bytes if they are neither, damaged, or over 2^28 pixels.
Image decode_image(std::span<const std::uint8_t> bytes, const std::string& object);

// A colour of 8 bits per channel, sRGB, as in files and on screens.
struct Rgb {
    std::uint8_t r = 0, g = 0, b = 0;

    bool operator==(const Rgb&) const = default;
    auto operator<=>(const Rgb&) const = default;
};
static_assert(sizeof(Rgb) == 3);

// Converts a value of sRGB in [0, 1] to linear light in [0, 1] (IEC 61966-2-1); values outside are clamped.
float linear_of_srgb(float encoded);
float srgb_of_linear(float linear);  // the inverse
vec3 linear_of(Rgb color);           // each channel
Rgb rgb_of_linear(vec3 linear);      // each channel, rounded

// Writes width * height `pixels`, row 0 on top, whole or not at all. Throws Error naming the file.
void write_png(const std::filesystem::path& file, uint width, uint height, std::span<const Rgb> pixels);

// An image of linear radiance, row 0 on top.
struct HdrImage {
    // The position of a part of an image in the whole, in pixels.
    struct Part {
        uint x = 0, y = 0, whole_width = 0, whole_height = 0;
    };
    uint width = 0;
    uint height = 0;
    std::vector<vec3> rgb;
    std::optional<Part> part = {};  // none: the image is whole
};

// Reads .hdr (Radiance RGBE) or .exr (any OpenEXR compression, first part, R G B or Y), chosen by the suffix. To make a
// map usable as light, infinities become the largest half (65504), NaN and negative values 0.
HdrImage load_hdr_image(const std::filesystem::path& file);

// A further channel of an image, row 0 on top: 32-bit float or unsigned integers.
struct ImageChannel {
    std::string name;
    std::variant<std::vector<float>, std::vector<uint>> values;
};

// Returns the exposure in stops that brings the geometric mean luminance of the non-black pixels to a grey of 0.18.
float automatic_exposure(const HdrImage& image);

// Writes by suffix: .exr, linear 32-bit float, without exposure; .png, 8-bit sRGB, `exposure` stops brighter and tone
// mapped with Khronos PBR Neutral. A part of an image is the data window of an .exr whose display window is the whole.
// Replaces an existing file only at the end. Throws Error naming the file. `channels` are further ones, for .exr.
void write_image(const std::filesystem::path& file, const HdrImage& image, float exposure,
                 std::span<const ImageChannel> channels = {});

// Returns whether write_image() supports the suffix.
bool is_image_file(const std::filesystem::path& file);

// ---- Animation: skins, morph targets and node hierarchies of glTF 2.0 (3.7.2.2, 3.7.3 and 3.11) ---------------------
// They are posed in float64. Scene::rig holds them; all else of a loaded scene is in the rest pose.

// The time range of an animation.
struct TimeRange {
    double begin = 0, end = 0;  // seconds
};
// The description of an animation in a file.
struct AnimationInfo {
    std::string name;
    TimeRange range;    // the first and the last time of its keyframes; 0, 0 without any
    std::string fault;  // why it cannot be played; empty: it can
};
std::vector<AnimationInfo> animations_of(const Rig& rig);  // in the file's order

// The positions of all nodes of a rig, and the weights of its morph targets. Cheap to copy.
class Pose {
  public:
    struct Nodes;
    // Internal: use rest_pose() and pose_at().
    explicit Pose(std::shared_ptr<const Nodes> nodes) : nodes_(std::move(nodes)) {}
    const Nodes* operator->() const { return nodes_.get(); }  // internal

  private:
    std::shared_ptr<const Nodes> nodes_;
};
Pose rest_pose(const Rig& rig);  // the nodes as in the file
// Returns the pose at a time of an animation, by its index in animations_of(); before its first keyframe and after its
// last, it stands still. Nodes that the animation does not drive are at rest.
Pose pose_at(const Rig& rig, std::size_t animation, double seconds);

// Moves instances, cameras and lights of a scene with its rig. Transforms follow the pose even if they become singular
// or not finite. A camera or light whose frame has an axis without length stays. Meshes stay: see deformed().
void pose_scene(Scene& scene, const Pose& pose);

// Returns transforms by index in Scene::instances, as pose_scene() sets them.
std::vector<Transform> instance_transforms(const Rig& rig, const Pose& pose);

// Lets instances that have no area until an animation scales their node be pushed. Call it before the scene is pushed
// into an accelerator and played: until the first pose_scene() they stand at the identity.
void show_hidden(Scene& scene);

// Returns the meshes whose vertices follow a pose, by skin or morph targets: indices into Scene::meshes, which holds
// them in the rest pose.
std::vector<uint> deformed_meshes(const Rig& rig);

// The vertices of a mesh, as in Mesh.
struct MeshVertices {
    std::vector<vec3> positions, normals;
    std::vector<vec4> tangents;
};
// Returns the vertices of deformed_meshes(rig)[index] in a pose: morph targets, then linear blend skinning, in float64,
// rounded once. Normals follow the cofactors of the blended matrix, so that they agree with the triangles' winding, and
// tangents the matrix itself; both become unit vectors, or 0 if they have no direction.
MeshVertices deformed(const Rig& rig, std::size_t index, const Pose& pose);

// The same on the device, in float32: one dispatch per mesh. Its output has the layout that
// AbstractAccel::update_vertices() takes.
class Deformer {
  public:
    // Uploads the data that no pose changes.
    Deformer(Context& context, std::shared_ptr<const Rig> rig);
    ~Deformer();

    // Vertices in device memory, tightly packed: 3, 3 and 4 floats each; 0 bytes for attributes that the mesh lacks.
    struct Output {
        const Buffer &positions, &normals, &tangents;
        std::size_t vertex_count;
    };
    // Returns the vertices of deformed_meshes(rig)[index] as record() last wrote them.
    Output output(std::size_t index) const;

    // Records the computation of all meshes' vertices in this pose. Later passes see them.
    void record(Commands& commands, const Pose& pose);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// ---- Textures in kernels: docs/multi-type-set.md --------------------------------------------------------------------

// The type of a texel's numbers.
enum class TexelFormat : std::uint8_t { unorm8, unorm16, float16, float32 };
// Returns the bytes of one number.
constexpr uint bytes_of(TexelFormat format) {
    return format == TexelFormat::unorm8 ? 1 : format == TexelFormat::float32 ? 4 : 2;
}

// Texels as a TextureStore takes them, tightly packed, row 0 (v = 0) first.
struct Texels {
    std::string name;
    uint width = 0, height = 0;
    uint channels = 4;  // 1 to 4, red first; missing colours are 0 and missing alpha is 1, as in Vulkan
    TexelFormat format = TexelFormat::unorm8;
    // The image, then any number of its mipmaps: each half as wide and as high as the one before, rounded down, at
    // least 1.
    std::vector<std::vector<std::byte>> levels;

    // Copies the numbers unchanged.
    template <class T>
    static Texels of(std::string name, uint width, uint height, uint channels, TexelFormat format,
                     std::span<const T> numbers) {
        const std::span<const std::byte> bytes = std::as_bytes(numbers);
        return {std::move(name), width, height, channels, format, {{bytes.begin(), bytes.end()}}};
    }
    // Takes an image of a scene, without mipmaps.
    static Texels of(const Image& image);
};

// Adds mipmaps down to one texel: the mean of what each texel covers, in float64; with is_srgb, of linear light. Throws
// Error unless there are as many texels as width and height say.
Texels with_mipmaps(Texels texels, bool is_srgb = false);

// How kernels reach textures.
enum class TextureStorage : std::uint8_t {
    images,   // through an array of descriptors, by the device's samplers: kernels compiled with TWINRAY_BINDLESS
    buffers,  // by device address, filtered in float32: everywhere, including trace programs
};

// How a texture is sampled.
struct TextureOptions {
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    bool is_srgb = false;  // for unorm8 and unorm16
    Filter filter = Filter::linear;
    Filter between_levels = Filter::linear;  // for sample_texture_lod()
    bool operator==(const TextureOptions&) const = default;
};

// Textures that kernels name by a TextureRef, which stays valid as long as the store lives. Edits only note what
// changes; sync() uploads the changes and never waits for the GPU. Wrong use throws Error naming the store, the texture
// and the limit, and leaves the store unchanged.
class TextureStore {
  public:
    // Returns the best storage for a device: images if it has descriptor indexing and its allocator makes images.
    static TextureStorage best_storage(const Context& context);

    // Throws Error for `images` unless best_storage() returns it.
    TextureStore(Context& context, std::string name, TextureStorage storage);
    TextureStore(Context& context, std::string name);
    ~TextureStore();

    // Copies the texels until the next sync. Throws Error for an image with none, or with another number than it says.
    TextureRef push(const Texels& texels, const TextureOptions& options = {});
    TextureRef push(const Image& image, const TextureOptions& options = {});
    // Replaces the texels; they are sampled as before. If size, channels, format and levels are the same, they go into
    // the same memory and views stay valid.
    void update(TextureRef ref, const Texels& texels);
    void update(TextureRef ref, const Image& image);
    bool contains(TextureRef ref) const;  // whether it names a texture of this store
    std::size_t size() const;             // the number of textures

    // Uploads what changed since the last sync; a clean store does nothing and returns the last sync point.
    SyncPoint sync();
    // Records the same into commands that may hold other work, as AbstractAccel::sync does.
    void sync(Commands& commands);

    // Returns the table that kernels take by value, until the next sync() after which revision() has grown. Throws
    // Error if edits are pending.
    TextureTable view() const;
    // Returns the descriptors that belong to the view, for Kernel::dispatch; null if textures are in buffers or there
    // are none.
    VkDescriptorSet images() const;
    // Counts the syncs that added textures or replaced one by another size: earlier views are stale.
    std::uint64_t revision() const;
    // Returns the bytes of textures in buffers: texels and records.
    std::uint64_t buffer_bytes() const;
    // Returns whether the storage is TextureStorage::images.
    bool has_images() const;

    // Throws Error if kernels compiled with TWINRAY_DEBUG met references that name nothing. Waits for the GPU.
    void check_faults() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace twinray
