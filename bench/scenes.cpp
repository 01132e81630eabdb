#include "bench/scenes.h"

#include <algorithm>
#include <charconv>
#include <map>

#include <twinray/tlas.h>

#include "engine/core/error.h"
#include "engine/core/platform.h"
#include "twinray/glsl/cpp_spawn.h"
#include "validation/reference/aimed_rays.h"

namespace twinray::bench {
namespace {

constexpr uint scene_seed = 7;

std::optional<std::string_view> after(std::string_view prefix, std::string_view name) {
    if (name.substr(0, prefix.size()) != prefix) return std::nullopt;
    return name.substr(prefix.size());
}

uint number(const std::string& scene, std::string_view text_of_number, uint least, uint most) {
    double value = 0;
    const char* end = text_of_number.data() + text_of_number.size();
    const auto [stop, error] = std::from_chars(text_of_number.data(), end, value);
    if (error != std::errc() || stop != end || !(value >= least && value <= most) || value != std::floor(value))
        fail("scene '", scene, "': '", text_of_number, "' is not a whole number from ", least, " to ", most);
    return static_cast<uint>(value);
}

uint triangle_number(const std::string& scene, std::string_view text_of_number) {
    return number(scene, text_of_number, 20, 50'000'000);
}

Scene of_mesh(Mesh&& mesh) {
    Scene scene;
    scene.instances.push_back({mesh.name, 0, {}});
    scene.meshes.push_back(std::move(mesh));
    return scene;
}

// Returns a uniform random rotation: its quaternion q is uniform on the unit sphere in 4 dimensions.
glm::dmat3 random_rotation(Draws& draws) {
    for (;;) {
        const double w = draws.between(-1, 1), x = draws.between(-1, 1), y = draws.between(-1, 1),
                     z = draws.between(-1, 1);
        const double square = w * w + x * x + y * y + z * z;
        if (square > 1 || square < 0x1p-10) continue;
        const double s = 2 / square;
        return {1 - s * (y * y + z * z), s * (x * y + w * z),     s * (x * z - w * y),
                s * (x * y - w * z),     1 - s * (x * x + z * z), s * (y * z + w * x),
                s * (x * z + w * y),     s * (y * z - w * x),     1 - s * (x * x + y * y)};
    }
}

Transform random_placement(uint count, uint index) {
    Draws draws(scene_seed, index);
    const glm::dmat3 rotation = random_rotation(draws);
    const double size = draws.between(0.6, 1.2) / std::cbrt(count);
    const dvec3 scale(size, size * draws.between(0.7, 1.3), size);
    Transform placement;
    for (int row = 0; row < 3; ++row) {
        const dvec3 linear = dvec3(rotation[0][row], rotation[1][row], rotation[2][row]) * scale;
        placement.rows[static_cast<std::size_t>(row)] = vec4(vec3(linear), draws.between(-1, 1));
    }
    return placement;
}

Scene instances(const std::string& name, std::string_view sizes) {
    const std::size_t cross = sizes.find('x');
    if (cross == std::string_view::npos) fail("scene '", name, "': instances:KxN needs two numbers, such as 1000x5120");
    const uint count = number(name, sizes.substr(0, cross), 1, 1'000'000);
    Scene scene = of_mesh(make_displaced_sphere(geodesic_frequency(triangle_number(name, sizes.substr(cross + 1)))));
    scene.instances.clear();
    for (uint i = 0; i < count; ++i) scene.instances.push_back({"", 0, random_placement(count, i)});
    return scene;
}

std::optional<Scene> generated(const std::string& name) {
    if (const auto triangles = after("sphere:", name))
        return of_mesh(make_displaced_sphere(geodesic_frequency(triangle_number(name, *triangles))));
    if (const auto triangles = after("soup:", name)) {
        const uint count = triangle_number(name, *triangles);
        return of_mesh(make_soup(count, scene_seed, std::sqrt(3.0f) / std::cbrt(static_cast<float>(count))));
    }
    if (const auto sizes = after("instances:", name)) return instances(name, *sizes);
    return std::nullopt;
}

Bounds scaled(const Bounds& bounds, float factor) {
    const vec3 half = bounds.size() * (0.5f * factor);
    return {bounds.center() - half, bounds.center() + half};
}

// Returns a number in [-1, 1) for each point of the integer lattice.
double lattice_value(int x, int y, int z) {
    const auto part = [](int i, int shift) { return static_cast<std::uint64_t>(i + (1 << 20)) << shift; };
    return Draws(0, part(x, 0) | part(y, 21) | part(z, 42)).between(-1, 1);
}

// Perlin's fade: first and second derivative vanish at both ends.
double faded(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

// Value noise: smooth between the lattice's values.
double noise(const dvec3& p) {
    const dvec3 cell = floor(p);
    const dvec3 way(faded(p.x - cell.x), faded(p.y - cell.y), faded(p.z - cell.z));
    const ivec3 corner(cell);
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
        const ivec3 step(i & 1, i >> 1 & 1, i >> 2);
        const double weight =
            (step.x ? way.x : 1 - way.x) * (step.y ? way.y : 1 - way.y) * (step.z ? way.z : 1 - way.z);
        sum += weight * lattice_value(corner.x + step.x, corner.y + step.y, corner.z + step.z);
    }
    return sum;
}

double radius(const dvec3& direction) {
    double relief = 0, amplitude = 0.5, frequency = 2;
    for (int octave = 0; octave < 5; ++octave, amplitude *= 0.5, frequency *= 2.5)
        relief += amplitude * noise(direction * frequency);
    return 1 + 0.25 * relief;
}

// Builds one face of the icosahedron at a time, in rows. Faces share the vertices on their edges.
class Geodesic {
  public:
    explicit Geodesic(uint frequency) : n_(frequency), icosahedron_(make_icosphere(0)) {
        for (const vec3& corner : icosahedron_.positions) points.emplace_back(corner);
        for (const uvec3& face : icosahedron_.triangles) add_face(face);
    }
    std::vector<dvec3> points;
    std::vector<uvec3> triangles;

  private:
    uint add_point(const dvec3& from, const dvec3& to, uint step, uint steps) {
        const double way = static_cast<double>(step) / steps;
        points.push_back(from * (1 - way) + to * way);
        return static_cast<uint>(points.size() - 1);
    }

    // Returns the n + 1 vertices from corner a to corner b.
    std::vector<uint> edge(uint a, uint b) {
        std::vector<uint>& kept = edges_[std::minmax(a, b)];
        if (kept.empty()) {
            const auto [first, last] = std::minmax(a, b);
            const dvec3 from = points[first], to = points[last];
            kept.push_back(first);
            for (uint i = 1; i < n_; ++i) kept.push_back(add_point(from, to, i, n_));
            kept.push_back(last);
        }
        std::vector<uint> vertices = kept;
        if (a > b) std::ranges::reverse(vertices);
        return vertices;
    }

    void add_face(uvec3 face) {
        const std::vector<uint> left = edge(face.x, face.y), right = edge(face.x, face.z), base = edge(face.y, face.z);
        std::vector<uint> above = {face.x};
        for (uint row = 1; row <= n_; ++row) {
            std::vector<uint> here = {left[row]};
            const dvec3 from = points[left[row]], to = points[right[row]];
            for (uint i = 1; i < row; ++i) here.push_back(row == n_ ? base[i] : add_point(from, to, i, row));
            here.push_back(right[row]);
            for (uint i = 0; i < row; ++i) {
                triangles.emplace_back(above[i], here[i], here[i + 1]);
                if (i + 1 < row) triangles.emplace_back(above[i], here[i + 1], above[i + 1]);
            }
            above = std::move(here);
        }
    }

    uint n_;
    Mesh icosahedron_;
    std::map<std::pair<uint, uint>, std::vector<uint>> edges_;
};

// Makes ray i of `count` by make(i, point), each point equally often within one.
template <class Make>
std::vector<Ray> rays_from(std::span<const Surface> points, std::size_t count, const Make& make) {
    std::vector<Ray> rays;
    rays.reserve(count);
    for (std::size_t i = 0; i < count; ++i) rays.push_back(make(i, points[i * points.size() / count]));
    return rays;
}

std::vector<Hit> primary_hits(Context& context, const Scene& scene, std::span<const Ray> rays) {
    const bool can_refine =
        SwTlas::capability_on(context.properties(), Feature::level_refined).support != Support::unsupported;
    const Level level = can_refine ? Level::refined : Level::watertight;
    SwTlas accel(context, AccelOptions{.level = level});
    push_scene(accel, scene);
    return accel.closest_hits(rays, {.level = level});
}

// Returns a box above and beside `bounds`, clear of it, with sides of a quarter of its diagonal.
Bounds light_of(const Bounds& bounds) {
    const float diagonal = length(bounds.size());
    const vec3 center = bounds.center() + vec3(-0.4f, 0.9f, 0.4f) * diagonal;
    return {center - 0.125f * diagonal, center + 0.125f * diagonal};
}

}  // namespace

BenchScene make_scene(const std::string& name) {
    if (std::optional<Scene> scene = generated(name)) {
        const Bounds bounds = bounds_of(*scene);
        return {name, std::move(*scene), scaled(bounds, 0.7f)};  // about half of the picture is covered
    }
    Scene scene = load_scene(platform::path_of(name));
    const Bounds bounds = bounds_of(scene);
    return {name, std::move(scene), bounds};
}

std::size_t count_mesh_triangles(const Scene& scene) {
    std::size_t count = 0;
    for (const Mesh& mesh : scene.meshes) count += mesh.triangles.size();
    return count;
}

uint geodesic_frequency(double triangles) {
    return static_cast<uint>(std::max(1.0, std::round(std::sqrt(triangles / 20))));
}

Mesh make_displaced_sphere(uint frequency) {
    Geodesic geodesic(frequency);
    Mesh mesh;
    mesh.name = "displaced sphere";
    mesh.triangles = std::move(geodesic.triangles);
    for (const dvec3& point : geodesic.points) {
        const dvec3 direction = point / std::sqrt(dot(point, point));
        mesh.positions.emplace_back(direction * radius(direction));
    }
    return mesh;
}

std::vector<Surface> surfaces_of(const Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits) {
    std::vector<Placement> placements;
    for (const Instance& instance : scene.instances) {
        const auto& rows = instance.transform.rows;
        placements.push_back(placement_of(Rows{rows[0], rows[1], rows[2]}));
    }
    std::vector<Surface> points;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const Hit& hit = hits[i];
        if (!hit.hit) continue;
        const Mesh& mesh = scene.meshes[scene.instances[hit.instance_index].mesh];
        const uvec3 triangle = mesh.triangles[hit.primitive_index];
        const SurfacePoint point = surface_point(
            placements[hit.instance_index],
            {mesh.positions[triangle.x], mesh.positions[triangle.y], mesh.positions[triangle.z]}, vec2(hit.u, hit.v));
        points.push_back({spawn_position(point, true), spawn_position(point, false), point.normal,
                          dot(rays[i].direction, point.normal) < 0});
    }
    return points;
}

std::vector<Ray> incoherent_rays(std::span<const Surface> points, std::size_t count, std::uint64_t seed) {
    return rays_from(points, count, [&](std::size_t i, const Surface& point) {
        vec3 direction(Draws(seed, i).direction());
        if ((dot(direction, point.normal) > 0) != point.is_front) direction = -direction;
        return Ray{point.is_front ? point.front : point.back, 0, direction, INFINITY};
    });
}

std::vector<Ray> occlusion_rays(std::span<const Surface> points, const Bounds& bounds, std::size_t count,
                                std::uint64_t seed) {
    const Bounds light = light_of(bounds);
    return rays_from(points, count, [&](std::size_t i, const Surface& point) {
        Draws draws(~seed, i);
        const double x = draws.unit(), y = draws.unit(), z = draws.unit();
        const vec3 target = light.lo + light.size() * vec3(x, y, z);
        const vec3 origin = dot(target - point.front, point.normal) > 0 ? point.front : point.back;
        const float distance = length(target - origin);
        return Ray{origin, 0, (target - origin) / distance, std::nextafter(distance, 0.0f)};
    });
}

std::vector<Ray> shuffled_rays(std::vector<Ray> rays, std::uint64_t seed) {
    for (std::size_t left = rays.size(); left > 1; --left)
        std::swap(rays[left - 1], rays[Draws(seed, left).below(left)]);
    return rays;
}

std::array<std::vector<Ray>, all_ray_kinds.size()> make_rays(Context& context, const BenchScene& scene, uint width,
                                                             std::uint64_t seed) {
    const std::vector<Ray> primary = primary_rays(scene.framed, width);
    const std::vector<Surface> points = surfaces_of(scene.scene, primary, primary_hits(context, scene.scene, primary));
    if (points.empty()) fail("scene '", scene.name, "': none of ", primary.size(), " primary rays meets it");
    const std::vector<Ray> incoherent = incoherent_rays(points, primary.size(), seed);
    return {primary, incoherent, occlusion_rays(points, bounds_of(scene.scene), primary.size(), seed),
            shuffled_rays(incoherent, seed)};
}

}  // namespace twinray::bench
