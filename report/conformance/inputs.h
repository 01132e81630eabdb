// The input of a driver's structures and traces, as data on the host, random or spoiled, and the result of a trace. The
// same data makes the expectation.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include <twinray/geometry.h>

#include "engine/core/ray.h"

namespace twinray::conformance {

constexpr VkBuildAccelerationStructureFlagsKHR can_update = VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;

enum class Indices : std::uint8_t { none, bits16, bits32 };

// Triangles, or boxes if there are any.
struct GeometryInput {
    std::vector<vec3> positions = {};
    std::vector<uvec3> triangles = {};  // with Indices::none these are (0, 1, 2), (3, 4, 5), ...
    std::vector<Bounds> boxes = {};
    VkGeometryFlagsKHR flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
    Indices indices = Indices::bits32;
    VkFormat format = VK_FORMAT_R32G32B32_SFLOAT;  // of positions, which it can hold
    std::uint32_t padding = 0;                     // bytes between one vertex or box and the next
    std::optional<Transform> transform = {};
    // Data in the buffers before the input, which the build must skip.
    std::uint32_t first_vertex = 0;    // vertices
    std::uint32_t earlier_items = 0;   // triangles of the index buffer, or boxes
    std::uint32_t earlier_places = 0;  // transforms

    bool is_boxes() const { return !boxes.empty(); }
    std::uint32_t primitive_count() const {
        return static_cast<std::uint32_t>(is_boxes() ? boxes.size() : triangles.size());
    }
};

struct BottomInput {
    std::vector<GeometryInput> geometries;
    VkBuildAccelerationStructureFlagsKHR flags = 0;
};

inline constexpr std::uint32_t no_bottom = UINT32_MAX;  // of an inactive instance

struct InstanceInput {
    std::uint32_t bottom = 0;  // index into SceneInput::bottoms, or no_bottom
    Transform to_world = {};
    std::uint32_t custom_index = 0;
    std::uint32_t mask = 0xff;
    std::uint32_t sbt_offset = 0;
    VkGeometryInstanceFlagsKHR flags = 0;
};

struct TopInput {
    std::vector<InstanceInput> instances;
    VkBuildAccelerationStructureFlagsKHR flags = 0;
    bool has_pointers = false;  // the build gets addresses of instances in place of instances
};

struct SceneInput {
    std::vector<BottomInput> bottoms;
    TopInput top;
};

#include "twinray/glsl/cpp_begin.h"
#include "shaders/conformance/query.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(Shot) == 56 && sizeof(Answer) == 128);

struct Traced {
    std::vector<Answer> answers;   // one per shot
    std::vector<uint> candidates;  // `slots` words for each shot
    uint slots = 0;

    // Returns the candidates that were offered, as many as there were slots for.
    std::span<const uint> candidates_of(std::size_t shot) const {
        const Answer& answer = answers[shot];
        return std::span(candidates).subspan(shot * slots, std::min(slots, answer.triangles + answer.boxes));
    }
};

inline constexpr uint no_flags = 0, all_instances = 0xff, refuse_all = 0xffffffff;

// A driver that is wrong on purpose: the negative controls of the suite. A control spoils the data on its way to the
// driver, or the answers on their way back, so that it runs on every driver.
enum class Misdeed : std::uint8_t {
    none,
    forgets_later_half,  // of the primitives of each geometry, at a build
    forgets_geometry_flags,
    forgets_transforms,  // of instances and geometries
    forgets_instance_masks,
    forgets_instance_flags,
    forgets_instance_ids,  // custom indices and record offsets
    forgets_updates,
    copies_in_part,  // copies and deserialised structures lack the later half
    forgets_ray_flags,
    forgets_ray_masks,
    forgets_refusals,
    forgets_limits,      // t_min and t_max
    moves_boxes,         // generates intersections elsewhere
    loses_candidates,    // does not report the last
    doubles_candidates,  // reports the last twice
    leaks,               // every eighth hit
    wavers,              // t and uv differ in every second trace
    garbles_headers,     // of serialised structures
    takes_any_file,
};
inline constexpr std::size_t misdeed_count = 20;
std::string_view name_of(Misdeed misdeed);  // "a driver that forgets updates"

void spoil(Misdeed misdeed, BottomInput& input);
void spoil(Misdeed misdeed, TopInput& input);
void spoil(Misdeed misdeed, std::vector<Shot>& shots);
// `turn`: the number of traces before this one.
void spoil(Misdeed misdeed, Traced& traced, std::size_t turn);

// Removes the part that an incomplete copy lacks.
void shorten(BottomInput& input);
void shorten(TopInput& input);

// Random scenes and rays lie on a grid of numbers, so that moves, turns and scales of them are exact. One seed gives
// the same numbers on every platform.
class Draws {
  public:
    explicit Draws(std::uint64_t seed) : engine_(seed) {}

    uint below(uint count) { return static_cast<uint>(engine_() % count); }
    bool chance(double share) { return unit() < share; }
    double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    // Returns a multiple of 2^-10 in [-extent, extent].
    float coordinate(float extent);
    vec3 point(float extent);
    // Returns multiples of 2^-8; the length is between 1/2 and 2.
    vec3 direction();

  private:
    std::mt19937_64 engine_;
};

constexpr uint usual_triangle_count = 24;
// Makes random triangles about the origin, within [-1.5, 1.5]. They are too large for rounding to turn them into edges.
GeometryInput random_triangles(Draws& draws, uint count = usual_triangle_count);
// Makes boxes one behind the other along z, from z = 2 i to 2 i + 1; x and y reach from -1 to 1.
GeometryInput layered_boxes(uint count);
// Makes the same as triangles at z = 2 i, larger than the boxes.
GeometryInput layered_triangles(uint count);
SceneInput scene_of(GeometryInput geometry);
SceneInput scene_of(std::vector<GeometryInput> geometries);
inline SceneInput usual_scene(Draws& draws) { return scene_of(random_triangles(draws)); }
// Makes two instances, because no bottom level may hold both.
SceneInput scene_of_both(std::vector<GeometryInput> triangles, std::vector<GeometryInput> boxes);

// Makes rays from afar through the middle of the scene; about every second one hits something.
std::vector<Shot> random_shots(Draws& draws, std::size_t count, float extent = 1);
// Makes rays along z through x, y in (-0.75, 0.75), from z = -1, for layered scenes.
std::vector<Shot> layer_shots(Draws& draws, std::size_t count);
// Makes the same rays, which hit each box in its middle.
std::vector<Shot> box_shots(Draws& draws, std::size_t count);
Shot shot_of(const Ray& ray);
// Returns a random transform that rotates, scales, shears and mirrors; its inverse loses little.
Transform random_instance_transform(Draws& draws);

}  // namespace twinray::conformance
