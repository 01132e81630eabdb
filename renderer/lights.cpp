// SPDX-License-Identifier: MIT
#include "renderer/lights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <twinray/scene.h>

#include "renderer/alias_table.h"
#include "renderer/material_kinds.h"

namespace twinray::path_tracer {
namespace {

// Nearest texel; wrapping other than repeat matters little for an estimate.
float texel_luminance(const Image& image, vec2 uv) {
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return 0;
    const vec2 at = uv - floor(uv);
    const uint x = std::min(static_cast<uint>(at.x * static_cast<float>(image.width)), image.width - 1);
    const uint y = std::min(static_cast<uint>(at.y * static_cast<float>(image.height)), image.height - 1);
    const std::size_t texel = (std::size_t{y} * image.width + x) * 4;
    const auto channel = [&](std::size_t i) {
        const float encoded = image.rgba16.empty() ? static_cast<float>(image.rgba[texel + i]) / 255.0f
                                                   : static_cast<float>(image.rgba16[texel + i]) / 65535.0f;
        return linear_of_srgb(encoded);
    };
    return luminance(vec3(channel(0), channel(1), channel(2)));
}

// Mean of the emission texture over a triangle, estimated; never 0, so that every emissive triangle can be chosen.
float mean_texture(const Scene& scene, const Texture& texture, const Mesh& mesh, const uvec3& triangle) {
    const std::vector<vec2>& uvs = mesh.uv_set(texture.uv_set);
    if (texture.image < 0 || uvs.empty()) return 1;
    constexpr vec2 points[] = {{1 / 3.f, 1 / 3.f}, {0.6f, 0.2f},  {0.2f, 0.6f}, {0.2f, 0.2f},
                               {0.45f, 0.45f},     {0.1f, 0.45f}, {0.45f, 0.1f}};
    float sum = 0;
    for (const vec2 p : points) {
        const vec2 uv = uvs[triangle.x] * (1 - p.x - p.y) + uvs[triangle.y] * p.x + uvs[triangle.z] * p.y;
        const vec3 affine(uv, 1);
        sum += texel_luminance(scene.images[static_cast<std::size_t>(texture.image)],
                               {dot(texture.uv_row0, affine), dot(texture.uv_row1, affine)});
    }
    return 0.01f + 0.99f * sum / static_cast<float>(std::size(points));
}

double world_area(const Mesh& mesh, const uvec3& triangle, const Transform& transform) {
    const dvec3 a(transform_point(transform, mesh.positions[triangle.x]));
    const dvec3 b(transform_point(transform, mesh.positions[triangle.y]));
    const dvec3 c(transform_point(transform, mesh.positions[triangle.z]));
    return 0.5 * length(cross(b - a, c - a));
}

// Collects weights first; probabilities follow when the sum is known.
struct Collector {
    const Scene& scene;
    LocalLights lights = {};
    std::vector<double> weights = {};
    std::vector<double> areas = {};  // of the emitters

    void add_instance(uint index) {
        const Instance& instance = scene.instances[index];
        const Mesh& mesh = scene.meshes[instance.mesh];
        for (uint primitive = 0; primitive < mesh.triangles.size(); ++primitive) {
            const uint material_index = instance.material.value_or(mesh.material(primitive));
            const Material& material = scene.materials[material_index];
            if (material.unlit || largest(material.emission) <= 0) continue;
            const uvec3& triangle = mesh.triangles[primitive];
            const double area = world_area(mesh, triangle, instance.transform);
            if (!(area > 0) || !std::isfinite(area)) continue;
            const float mean =
                luminance(material.emission) * mean_texture(scene, material.emission_texture, mesh, triangle);
            lights.emitters.push_back({index, primitive, material_index});
            areas.push_back(area);
            weights.push_back(double{PI} * area * double{mean} * (material.double_sided ? 2 : 1));
        }
    }

    void add_punctual(const Light& light, float scene_radius) {
        const float inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
        const float scale = 1 / std::max(inner - outer, 1e-3f);
        const bool is_spot = light.kind == Light::Kind::spot, is_sun = light.kind == Light::Kind::directional;
        lights.punctual.push_back({light.position,
                                   is_sun    ? PUNCTUAL_DIRECTIONAL
                                   : is_spot ? PUNCTUAL_SPOT
                                             : PUNCTUAL_POINT,
                                   light.direction, light.range, light.color, 0, scale, -outer * scale});
        const float solid_angle = is_spot ? 2 * PI * (1 - outer) : 4 * PI;
        weights.push_back(double{luminance(light.color)} *
                          double{is_sun ? PI * scene_radius * scene_radius : solid_angle});
    }

    void finish() {
        lights.table = make_alias_table(weights);
        lights.densities.resize(scene.instances.size());
        if (lights.empty()) return;
        const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
        for (std::size_t i = 0; i < lights.emitters.size(); ++i) {
            const Emitter emitter = lights.emitters[i];
            std::vector<float>& densities = lights.densities[emitter.instance];
            if (densities.empty())
                densities.resize(scene.meshes[scene.instances[emitter.instance].mesh].triangles.size());
            densities[emitter.primitive] = static_cast<float>(weights[i] / total / areas[i]);
        }
        for (std::size_t i = 0; i < lights.punctual.size(); ++i)
            lights.punctual[i].chance = static_cast<float>(weights[lights.emitters.size() + i] / total);
    }
};

template <class T>
void put_all(LocalLightSet& set, std::vector<SetKey>& keys, const std::vector<T>& lights) {
    for (std::size_t i = 0; i < lights.size(); ++i)
        if (i < keys.size())
            set.update(keys[i], lights[i]);
        else
            keys.push_back(set.push(lights[i]));
}

}  // namespace

std::vector<SetKey> LightSet::put(const LocalLights& lights) {
    put_all(set_, emitters_, lights.emitters);
    put_all(set_, punctual_, lights.punctual);
    set_.sync();
    const auto count = [](const auto& list) { return static_cast<std::ptrdiff_t>(list.size()); };
    std::vector<SetKey> keys(emitters_.begin(), emitters_.begin() + count(lights.emitters));
    keys.insert(keys.end(), punctual_.begin(), punctual_.begin() + count(lights.punctual));
    return keys;
}

LocalLights collect_lights(const Scene& scene) {
    Collector collector{scene};
    for (uint i = 0; i < scene.instances.size(); ++i) collector.add_instance(i);
    const float radius = 0.5f * length(bounds_of(scene).size());
    for (const Light& light : scene.lights) collector.add_punctual(light, radius);
    collector.finish();
    return std::move(collector.lights);
}

bool has_lamps(const Scene& scene) {
    const std::vector<bool> used = used_materials(scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (used[i] && largest(scene.materials[i].emission) > 1) return true;
    return !scene.lights.empty();
}

}  // namespace twinray::path_tracer
