// SPDX-License-Identifier: MIT
#include "viewer/layers.h"

#include <algorithm>
#include <cmath>

#include "engine/core/parallel.h"
#include "twinray/glsl/vector_math.h"

namespace twinray::viewer {
namespace {

constexpr Rgb hit_color = {70, 78, 90};
constexpr float light_at_least = 0.3f;

Rgb base_color(const Scene& scene, const Hit& hit) {
    const Instance& instance = scene.instances[hit.instance_index];
    const uint material = instance.material.value_or(scene.meshes[instance.mesh].material(hit.primitive_index));
    if (material >= scene.materials.size()) return plain_color;
    const Material& shown = scene.materials[material];
    const vec3 color(shown.base_color.x, shown.base_color.y, shown.base_color.z), specular = shown.specular_color;
    if (shown.ior != 0) return rgb_of_linear(color);
    // All of its reflection at normal incidence is the specular colour, as KHR_materials_pbrSpecularGlossiness has it.
    return rgb_of_linear(specular + color * (1 - std::max({specular.x, specular.y, specular.z})));
}

std::uint8_t byte_of(double share) { return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0, 1.0))); }

// Measures along the ray, from where it enters the sphere around the scene to where it leaves it.
Rgb depth_color(const Ray& ray, const Hit& hit, const Bounds& bounds) {
    const dvec3 middle = (dvec3(bounds.lo) + dvec3(bounds.hi)) * 0.5;
    const double radius = 0.5 * length(dvec3(bounds.hi) - dvec3(bounds.lo));
    const double away = length(dvec3(ray.origin) - middle), t = hit.t * length(dvec3(ray.direction));
    const double least = std::max(0.0, away - radius), most = away + radius;
    return color_at(ColorMap::magnitude, 1 - (t - least) / (most - least));
}

}  // namespace

std::vector<Ray> rays_of(const Orbit& orbit, uint width, uint height) {
    const ImagePlane plane = image_plane(camera_of(orbit), static_cast<float>(width) / static_cast<float>(height));
    std::vector<Ray> rays(std::size_t{width} * height);
    parallel_for(rays.size(), [&](std::size_t i) { rays[i] = ray_through(plane, in_plane(width, height, i)); });
    return rays;
}

Ray ray_of_pixel(const Orbit& orbit, uint width, uint height, uvec2 pixel) {
    const ImagePlane plane = image_plane(camera_of(orbit), static_cast<float>(width) / static_cast<float>(height));
    return ray_through(plane, in_plane(width, height, std::size_t{pixel.y} * width + pixel.x));
}

Rgb lit(const Scene& scene, const Ray& ray, const Hit& hit, Rgb color) {
    const dvec3 direction(ray.direction);
    const double cosine = std::abs(dot(front_normal(scene, hit), direction)) / std::max(length(direction), 1e-300);
    return rgb_of_linear(linear_of(color) * (light_at_least + (1 - light_at_least) * static_cast<float>(cosine)));
}

Rgb color_of_number(std::uint64_t number) {
    std::uint64_t z = (number + 1) * 0x9e3779b97f4a7c15u;  // splitmix64 (Steele, Lea, Flood 2014)
    z = (z ^ z >> 30u) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27u) * 0x94d049bb133111ebu;
    z ^= z >> 31u;
    const auto channel = [&](unsigned shift) { return static_cast<std::uint8_t>(64 + (z >> shift & 0xffu) * 3 / 4); };
    return {channel(0), channel(16), channel(32)};
}

Rgb color_of(Layer layer, const Scene& scene, const Ray& ray, const Hit& hit, const Bounds& bounds) {
    if (hit.hit == 0) return background;
    switch (layer) {
        case Layer::occlusion: return hit_color;
        case Layer::uv: return {byte_of(hit.u), byte_of(hit.v), byte_of(1.0 - hit.u - hit.v)};
        case Layer::normal: {
            const dvec3 n = front_normal(scene, hit);
            return {byte_of(0.5 + 0.5 * n.x), byte_of(0.5 + 0.5 * n.y), byte_of(0.5 + 0.5 * n.z)};
        }
        case Layer::geometry: return lit(scene, ray, hit, color_of_number(scene.instances[hit.instance_index].mesh));
        case Layer::primitive:
            return lit(scene, ray, hit,
                       color_of_number(std::uint64_t{hit.instance_index} << 32u | hit.primitive_index));
        case Layer::depth: return depth_color(ray, hit, bounds);
        default: return lit(scene, ray, hit, base_color(scene, hit));
    }
}

bool agree(const Hit& a, const Hit& b) {
    return a.hit == b.hit &&
           (a.hit == 0 || (a.instance_index == b.instance_index && a.primitive_index == b.primitive_index));
}

Raster enlarged(const Raster& coarse, uint width, uint height, uint grain) {
    Raster raster(width, height);
    for (uint y = 0; y < height; ++y)
        for (uint x = 0; x < width; ++x)
            raster.at(x, y) = coarse.at(std::min(x / grain, coarse.width - 1), std::min(y / grain, coarse.height - 1));
    return raster;
}

}  // namespace twinray::viewer
