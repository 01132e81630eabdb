// Scenes by name: generated ones, which anybody can measure again, and files; and a closed mesh with relief, of any
// size.
#pragma once

#include <string>

#include <twinray/scene.h>

#include "engine/accel/trace_desc.h"
#include "engine/core/context.h"
#include "twinray/glsl/cpp.h"

namespace twinray::bench {

struct BenchScene {
    std::string name;
    Scene scene;
    Bounds framed;  // the box that the camera of primary rays sees
};

// "sphere:N": make_displaced_sphere of about N triangles.
// "soup:N": N separate random triangles in a cube, each about as large as its share of it.
// "instances:KxN": K instances of such a sphere of about N triangles, in a cube, turned and stretched at random, each
// about as large as its share of it.
// Anything else is a file for load_scene. Numbers may be written as 1e6. The same name gives the same bits everywhere.
// Throws Error naming what is not a number or out of range.
BenchScene make_scene(const std::string& name);

// Returns into how many parts edges of the icosahedron are cut, so that 20 frequency^2 is nearest to `triangles`.
uint geodesic_frequency(double triangles);

// Makes a geodesic sphere about the origin, displaced along its radius by five octaves of noise: radii of 0.75 to 1.25.
// It is closed: vertices are shared, triangles face outwards. Its bits are the same everywhere. `frequency` >= 1.
Mesh make_displaced_sphere(uint frequency);

// Returns how many triangles are built: those of all meshes, whatever the number of their instances.
std::size_t count_mesh_triangles(const Scene& scene);

enum class RayKind : std::uint8_t {
    primary,     // a camera's
    incoherent,  // from where primary rays meet the scene, into the hemisphere on their side, uniform over solid angle
    occlusion,   // from the same points to random points of a light above and beside the scene
    shuffled,    // the incoherent rays in random order
};
inline constexpr std::array all_ray_kinds = {RayKind::primary, RayKind::incoherent, RayKind::occlusion,
                                             RayKind::shuffled};
// The kinds that a renderer traces, in its order.
inline constexpr std::array usual_ray_kinds = {RayKind::primary, RayKind::incoherent, RayKind::occlusion};
constexpr std::string_view name_of(RayKind kind) {
    constexpr std::string_view names[] = {"primary", "incoherent", "occlusion", "shuffled"};
    return names[static_cast<std::size_t>(kind)];
}
// Returns the query: any hits for occlusion, else closest hits.
constexpr Query query_of(RayKind kind) { return kind == RayKind::occlusion ? Query::any : Query::closest; }

// A point where a ray met the scene.
struct Surface {
    vec3 front, back;  // where rays that leave to this side of the triangle start, clear of it
    vec3 normal;       // unit, of the front
    bool is_front;     // the ray came from the front
};

// Returns the points that the hits name, in their order; leaves out misses.
std::vector<Surface> surfaces_of(const Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits);

// Returns `count` rays from the points in their order, each point equally often within one. Ray i depends only on
// (seed, i) and its point. Directions have length 1. There must be a point.
std::vector<Ray> incoherent_rays(std::span<const Surface> points, std::size_t count, std::uint64_t seed);
// Does the same towards a light, a cube outside `bounds`. t_max is the last float before the light's point.
std::vector<Ray> occlusion_rays(std::span<const Surface> points, const Bounds& bounds, std::size_t count,
                                std::uint64_t seed);

// Returns the same rays in an order that depends only on their number and the seed.
std::vector<Ray> shuffled_rays(std::vector<Ray> rays, std::uint64_t seed);

// Returns `width` * `width` rays of each RayKind, all but the shuffled ones in tiles of 8 x 8 pixels of the picture of
// primary rays. SwTlas finds the surface points, refined where the device has float64. `width` is a multiple of 8.
// Throws Error naming the scene if no primary ray meets it.
std::array<std::vector<Ray>, all_ray_kinds.size()> make_rays(Context& context, const BenchScene& scene, uint width,
                                                             std::uint64_t seed);

}  // namespace twinray::bench
