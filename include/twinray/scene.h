// SPDX-License-Identifier: MIT
// Scenes: meshes, materials, images, lights and cameras of a file, how they move, and how they reach an accelerator and
// kernels. Distances are in the file's unit, colours linear unless they say sRGB.
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
    std::vector<std::uint16_t> rgba16 = {};  // instead, of files with 16 bits a channel
    bool is_placeholder = false;             // a checkerboard in place of an image that could not be decoded
};

// What lies beyond an image's edges.
enum class Wrap : std::uint8_t { repeat, clamp_to_edge, mirrored_repeat };
// Of texels that are magnified.
enum class Filter : std::uint8_t { linear, nearest };

// An image with its sampling: uv' = rotation/scale/offset of KHR_texture_transform applied to the mesh's uv.
struct Texture {
    std::int32_t image = -1;  // index into Scene::images, -1 = none
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    Filter filter = Filter::linear;
    uint uv_set = 0;  // of the mesh, 0 or 1: see Mesh::uv_set
    // uv' = (row0 . (u, v, 1), row1 . (u, v, 1))
    vec3 uv_row0 = vec3(1, 0, 0);
    vec3 uv_row1 = vec3(0, 1, 0);
};

// As glTF has it.
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
    vec3 specular_color = vec3(1);  // linear, of its reflectance at normal incidence
    float clearcoat = 0;
    float clearcoat_roughness = 0;
    float clearcoat_normal_scale = 1;
    vec3 sheen_color = vec3(0);  // linear
    float sheen_roughness = 0;
    float anisotropy = 0;
    float anisotropy_rotation = 0;     // radians, from the tangent to the bitangent
    float thickness = 0;               // above 0: what transmits is the boundary of a volume, else a thin wall
    vec3 attenuation_color = vec3(1);  // linear: what is left of white light after attenuation_distance
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

// All textures of a material, those without an image too.
std::array<const Texture*, 13> textures_of(const Material& material);

// A mesh in the world.
struct Instance {
    std::string name;
    uint mesh = 0;  // index into Scene::meshes
    Transform transform;
    std::optional<uint> material = {};  // index into Scene::materials, in place of all of the mesh's
};

// KHR_materials_variants: other materials for the same triangles.
struct MaterialVariant {
    // The materials of one mesh.
    struct Part {
        uint mesh = 0;                // index into Scene::meshes
        std::vector<uint> materials;  // in place of Mesh::materials
    };
    std::string name;
    std::vector<Part> parts;
};

// Looks along -z of its frame, +y up (glTF).
struct Camera {
    std::string name;
    Transform camera_to_world;
    float vertical_fov = 0.8f;                      // radians; perspective
    std::optional<float> aspect;                    // width / height of its frame, when the file states one
    std::optional<float> orthographic_half_height;  // set: orthographic, in world units
};

// KHR_lights_punctual.
struct Light {
    // As KHR_lights_punctual names them.
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

struct Rig;  // what moves in a scene: see "Animation" below

// A point of the file is `origin` plus a point of the scene. The origin is 0 but for files whose coordinates float32
// cannot hold, as of what stands far away in metres of UTM: see load_scene(). Rays of such a file are made in float64
// and moved before they are rounded: ray.origin = vec3(point - scene.origin), and a hit is at
// scene.origin + dvec3(point).
struct Scene {
    dvec3 origin = dvec3(0);
    std::vector<Mesh> meshes;
    std::vector<Material> materials;  // never empty after load: entry for meshes without one is appended
    std::vector<Image> images;
    std::vector<Instance> instances;  // load_scene leaves them grouped by mesh, ascending
    std::vector<Camera> cameras;
    std::vector<Light> lights;
    std::vector<MaterialVariant> variants;
    std::shared_ptr<const Rig> rig;     // of files with animations; all else is in the rest pose. Null: nothing moves
    std::vector<std::string> warnings;  // what was skipped or replaced, one clear sentence each
};

// Loads .gltf, .glb (by tinygltf), .obj, .ply or .stl, the last three also with .gz, chosen by the suffix.
// Throws Error naming the file, the object and the limit on anything that cannot be rendered faithfully. `origin`: of
// the scene; none: 0, unless float32 would round coordinates by more than a millionth of their extent, then a point
// near their middle with as round numbers as the extent allows; dvec3(0): the file's coordinates, rounded.
Scene load_scene(const std::filesystem::path& file, const std::optional<dvec3>& origin = {});

// A box of [-1, 1]^3, open towards +z, with white walls, a red one left (-x), a green one right, a light under the
// ceiling, a metal box and a glass sphere; with a camera that sees all of it.
Scene cornell_box_scene();

// 1200 glazed and golden beads in the spiral of a sunflower on a table, seen from above at an aspect of 16 : 9; without
// lights, for a sky.
Scene sunflower_scene();

// "500000 5400000 0", in as few digits as give the same float64.
std::string origin_text(const dvec3& origin);

// Box of all instances' vertices in world space, as bounds_of(std::span<const PlacedMesh>).
Bounds bounds_of(const Scene& scene);

// Triangles counted once per instance.
std::size_t count_triangles(const Scene& scene);

// All instances as one mesh in world space. Vertices that meet in the scene meet there, if they are of one instance or
// of one transform. Triangles of a mirrored instance get their last two vertices exchanged, so that fronts stay fronts.
Mesh joined(const Scene& scene, std::string name);

// Gives the scene's meshes the materials of one of its variants. Throws Error naming those it has.
void apply_variant(Scene& scene, const std::string& name);

// Pushes every mesh with all its instances, so that Hit::instance_index is the index into scene.instances and
// Hit::custom_index 1 + Instance::material, or 0 where it has none. Returns one handle per mesh that has instances.
// Throws Error unless scene.instances is grouped by mesh, as load_scene leaves it.
std::vector<AccelHandle> push_scene(AbstractAccel& accel, const Scene& scene);

// What an accelerator holds after a sync, with vertices and transforms as kernels have left them: a mesh for each
// handle, in the order of AbstractAccel::handles(), and instances in the order of Hit::instance_index. Positions and
// triangles alone; boxes become meshes without triangles. Waits, for what sync(Commands&) has recorded too, which must
// be submitted. Throws Error for an instance whose transform is unusable.
Scene scene_of(AbstractAccel& accel);

// ---- Views of a scene -----------------------------------------------------------------------------------------------

// A perspective camera. fov: vertical, in degrees. Throws Error unless `at` lies elsewhere, in another direction than
// up.
Camera look_camera(vec3 from, vec3 at, vec3 up, float fov);

// The whole scene with a vertical field of view of 40 degrees; aspect: width / height of the picture. `direction`: in
// which it looks, in world space; without, from the front right and above, but turned to where surfaces face if they
// face one way, so that rooms are seen through their open side and pictures from the front. Up is +y, or -z in pictures
// that look straight up or down. `also`: points in world space that are seen, too. Throws Error for a direction that is
// 0 or not finite.
Camera frame_scene(const Scene& scene, float aspect, const std::optional<vec3>& direction = {},
                   std::span<const dvec3> also = {});

// What a camera sees. The point (x, y) of its picture, from -1 to 1 to the right and upwards, shows what lies from
// `origin` along forward + right * x + up * y; in orthographic pictures from origin + right * x + up * y along forward.
struct ImagePlane {
    vec3 origin, right, up, forward;  // `forward` is as long as 1, and the three are perpendicular
    bool is_orthographic;
};
// All of the camera's frame is seen, whatever the picture's aspect, and what is beside it.
ImagePlane image_plane(const Camera& camera, float aspect);

// Its `t` is the depth along `forward`.
Ray ray_through(const ImagePlane& plane, vec2 point);

// Where project() puts a point.
struct Projected {
    vec2 point;
    float depth;
};
// None for points behind the camera.
std::optional<Projected> project(const ImagePlane& plane, dvec3 position);

// ---- Images ---------------------------------------------------------------------------------------------------------

// Decodes PNG or JPEG; grey and RGB are widened to RGBA.
// Throws Error naming `object` and what the bytes seem to be when they are neither, damaged, or over 2^28 pixels.
Image decode_image(std::span<const std::uint8_t> bytes, const std::string& object);

// 8 bits a channel, sRGB, as files and screens have them.
struct Rgb {
    std::uint8_t r = 0, g = 0, b = 0;

    bool operator==(const Rgb&) const = default;
    auto operator<=>(const Rgb&) const = default;
};
static_assert(sizeof(Rgb) == 3);

// Linear light in [0, 1] of a value of sRGB in [0, 1] (IEC 61966-2-1), and back; what is outside is brought inside.
float linear_of_srgb(float encoded);
float srgb_of_linear(float linear);  // back
vec3 linear_of(Rgb color);           // by channel
Rgb rgb_of_linear(vec3 linear);      // by channel, rounded

// `pixels`: width * height of them, row 0 on top. Whole or not at all; throws Error naming the file.
void write_png(const std::filesystem::path& file, uint width, uint height, std::span<const Rgb> pixels);

// Linear radiance, row 0 on top.
struct HdrImage {
    // Where a part of an image lies in the whole, in pixels.
    struct Part {
        uint x = 0, y = 0, whole_width = 0, whole_height = 0;
    };
    uint width = 0;
    uint height = 0;
    std::vector<vec3> rgb;
    std::optional<Part> part = {};  // none: it is whole
};

// Reads .hdr (Radiance RGBE) or .exr (any OpenEXR compression, first part, R G B or Y), chosen by the suffix.
// So that a map can be sampled as light, infinities become the largest half (65504), NaN and negative values 0.
HdrImage load_hdr_image(const std::filesystem::path& file);

// More of each pixel, row 0 on top: 32-bit float or unsigned integers.
struct ImageChannel {
    std::string name;
    std::variant<std::vector<float>, std::vector<uint>> values;
};

// Exposure in stops that brings the geometric mean luminance of the pixels that are not black to a middle grey of 0.18.
float automatic_exposure(const HdrImage& image);

// By suffix: .exr, linear 32-bit float, without exposure; .png, 8-bit sRGB, `exposure` stops brighter and tone mapped
// with Khronos PBR Neutral. A part of an image is the data window of an .exr whose display window is the whole. What
// was there before is replaced at the end. Throws Error naming the file. channels: more of them, for .exr.
void write_image(const std::filesystem::path& file, const HdrImage& image, float exposure,
                 std::span<const ImageChannel> channels = {});

// Whether write_image knows the suffix.
bool is_image_file(const std::filesystem::path& file);

// ---- Animation: skins, morph targets and node hierarchies as glTF 2.0 has them (3.7.2.2, 3.7.3 and 3.11), posed in
// float64. Scene::rig holds them; all else of a loaded scene is in the rest pose
// ---------------------------------------

// Of an animation.
struct TimeRange {
    double begin = 0, end = 0;  // seconds
};
// What a file says of an animation.
struct AnimationInfo {
    std::string name;
    TimeRange range;    // the first and the last time of its keyframes; 0, 0 without any
    std::string fault;  // why it cannot be played; empty: it can
};
std::vector<AnimationInfo> animations_of(const Rig& rig);  // in the file's order

// Where all nodes of a rig are, and the weights of its morph targets. Cheap to copy.
class Pose {
  public:
    struct Nodes;
    // Made by rest_pose() and pose_at().
    explicit Pose(std::shared_ptr<const Nodes> nodes) : nodes_(std::move(nodes)) {}
    const Nodes* operator->() const { return nodes_.get(); }  // for twinray's own parts

  private:
    std::shared_ptr<const Nodes> nodes_;
};
Pose rest_pose(const Rig& rig);  // as the file has its nodes
// At a time of an animation, by its index in animations_of(); before its first keyframe and after its last it stands
// still. What the animation does not drive is at rest.
Pose pose_at(const Rig& rig, std::size_t animation, double seconds);

// Moves instances, cameras and lights of a scene with its rig. Transforms are what the pose makes of them, also
// singular or not finite. A camera or light whose frame has an axis without length stays. Meshes stay: see deformed().
void pose_scene(Scene& scene, const Pose& pose);

// By index in Scene::instances, as pose_scene() sets them.
std::vector<Transform> instance_transforms(const Rig& rig, const Pose& pose);

// Gives instances that are flat at rest, without an inverse, until an animation scales their node, a place in the
// scene, before it is pushed into an accelerator and played: until the first pose_scene() they stand at the identity.
void show_hidden(Scene& scene);

// The meshes whose vertices follow a pose, by skin or morph targets: indices into Scene::meshes, which holds them in
// the rest pose.
std::vector<uint> deformed_meshes(const Rig& rig);

// The vertices of a mesh, as in Mesh.
struct MeshVertices {
    std::vector<vec3> positions, normals;
    std::vector<vec4> tangents;
};
// The vertices of deformed_meshes(rig)[index] in a pose: morph targets, then linear blend skinning, in float64, rounded
// once. Normals go by the cofactors of the blended matrix, so that they agree with the triangles' winding, and tangents
// by the matrix itself; both become unit vectors, or 0 where they have no direction.
MeshVertices deformed(const Rig& rig, std::size_t index, const Pose& pose);

// The same on the device, in float32: one dispatch a mesh. What it writes is laid out as
// AbstractAccel::update_vertices() takes it.
class Deformer {
  public:
    // Uploads what no pose changes.
    Deformer(Context& context, std::shared_ptr<const Rig> rig);
    ~Deformer();

    // Vertices in device memory, tightly packed: 3, 3 and 4 floats each. Of 0 bytes where the mesh has none.
    struct Output {
        const Buffer &positions, &normals, &tangents;
        std::size_t vertex_count;
    };
    // Of deformed_meshes(rig)[index]; what record() wrote last.
    Output output(std::size_t index) const;

    // The vertices of all meshes in this pose. Later passes see them.
    void record(Commands& commands, const Pose& pose);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// ---- Textures in kernels: docs/multi-type-set.md --------------------------------------------------------------------

// What a number of a texel is.
enum class TexelFormat : std::uint8_t { unorm8, unorm16, float16, float32 };
// Of one number.
constexpr uint bytes_of(TexelFormat format) {
    return format == TexelFormat::unorm8 ? 1 : format == TexelFormat::float32 ? 4 : 2;
}

// Texels as a TextureStore takes them, tightly packed, row 0 (v = 0) first.
struct Texels {
    std::string name;
    uint width = 0, height = 0;
    uint channels = 4;  // 1 to 4, red first; of those that lack colours are 0 and alpha is 1, as Vulkan has it
    TexelFormat format = TexelFormat::unorm8;
    // The image, then its mipmaps: each half as wide and as high as the one before, rounded down, 1 at least. Any
    // number of them.
    std::vector<std::vector<std::byte>> levels;

    // Of numbers as they are.
    template <class T>
    static Texels of(std::string name, uint width, uint height, uint channels, TexelFormat format,
                     std::span<const T> numbers) {
        const std::span<const std::byte> bytes = std::as_bytes(numbers);
        return {std::move(name), width, height, channels, format, {{bytes.begin(), bytes.end()}}};
    }
    // Of an image of a scene, without mipmaps.
    static Texels of(const Image& image);
};

// With mipmaps down to one texel: the mean of what each texel covers, in float64; is_srgb: of linear light. Throws
// Error for texels that are not as many as width and height say.
Texels with_mipmaps(Texels texels, bool is_srgb = false);

// How kernels reach textures.
enum class TextureStorage : std::uint8_t {
    images,   // through an array of descriptors, by the device's samplers: kernels compiled with TWINRAY_BINDLESS
    buffers,  // by device address, filtered in float32: everywhere, in trace programs too
};

// How a texture is sampled.
struct TextureOptions {
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    bool is_srgb = false;  // of unorm8 and unorm16
    Filter filter = Filter::linear;
    Filter between_levels = Filter::linear;  // of sample_texture_lod()
    bool operator==(const TextureOptions&) const = default;
};

// Textures that kernels name by a TextureRef, which stays valid for as long as the store lives. Edits only note what
// changes; sync() uploads that and never waits for the GPU. Wrong use throws Error naming the store, the texture and
// the limit, and leaves the store as it was.
class TextureStore {
  public:
    // What a device allows: images where it has descriptor indexing and its allocator makes images.
    static TextureStorage best_storage(const Context& context);

    // Throws Error for images where best_storage() is not that.
    TextureStore(Context& context, std::string name, TextureStorage storage);
    TextureStore(Context& context, std::string name);
    ~TextureStore();

    // Copies the texels until the next sync. Throws Error for an image with none, or another number than it says.
    TextureRef push(const Texels& texels, const TextureOptions& options = {});
    TextureRef push(const Image& image, const TextureOptions& options = {});
    // Other texels, sampled as before. Where size, channels, format and levels are the same they go into the same
    // memory and views stay valid.
    void update(TextureRef ref, const Texels& texels);
    void update(TextureRef ref, const Image& image);
    bool contains(TextureRef ref) const;  // whether it names one of this store
    std::size_t size() const;             // how many textures there are

    // Uploads what changed since the last sync; a clean store does nothing and returns the last sync point.
    SyncPoint sync();
    // The same into commands that hold other work, as AbstractAccel::sync does.
    void sync(Commands& commands);

    // What kernels take, by value, until the next sync() after which revision() has grown. Throws Error if edits are
    // pending.
    TextureTable view() const;
    // The descriptors that go with the view, for Kernel::dispatch; null where textures are in buffers or there are
    // none.
    VkDescriptorSet images() const;
    // Counts the syncs that brought textures or replaced one by another size: views of before are stale.
    std::uint64_t revision() const;
    // Bytes of textures in buffers: texels and records.
    std::uint64_t buffer_bytes() const;
    // TextureStorage::images.
    bool has_images() const;

    // Throws Error if kernels compiled with TWINRAY_DEBUG met references that name nothing. Waits for the GPU.
    void check_faults() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace twinray
