// SPDX-License-Identifier: MIT
#include "bench/scenes.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include <twinray/scene.h>

#include "engine/core/platform.h"
#include "engine/core/error.h"
#include <twinray/geometry.h>
#include "validation/reference/draws.h"

namespace twinray::bench {
namespace {

constexpr uint seed = 7;

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
    Draws draws(seed, index);
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
        return of_mesh(make_soup(count, seed, std::sqrt(3.0f) / std::cbrt(static_cast<float>(count))));
    }
    if (const auto sizes = after("instances:", name)) return instances(name, *sizes);
    return std::nullopt;
}

Bounds scaled(const Bounds& bounds, float factor) {
    const vec3 half = bounds.size() * (0.5f * factor);
    return {bounds.center() - half, bounds.center() + half};
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

}  // namespace twinray::bench
