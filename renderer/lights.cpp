#include "renderer/lights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <twinray/scene.h>

#include "renderer/material_kinds.h"
#include "samples/support/text.h"

namespace twinray::path_tracer {
using samples::text;
namespace {

uint word_of(double probability) { return static_cast<uint>(std::clamp(probability * 0x1p32, 0.0, 0x1p32 - 1)); }

// Returns "'sun'", or "'sun' and 2 others".
std::string names_of(const std::vector<Light>& lights) {
    const std::size_t others = lights.size() - 1;
    const std::string first = text("'", lights[0].name, "'");
    return others == 0 ? first : text(first, " and ", others, others == 1 ? " other" : " others");
}

// Samples the nearest texel; wrapping other than repeat matters little for an estimate.
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

// Estimates the mean of the emission texture over a triangle; never 0, so that every emissive triangle can be chosen.
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

constexpr float flat_cosine = 1 - 0x1p-20f;  // of the angle between two halves of a quadrilateral

// Returns whether the triangle shares two vertices with the other of the mesh.
bool have_an_edge(const Mesh& mesh, uint other, const uvec3& triangle) {
    uint shared = 0;
    const uvec3& before = mesh.triangles[other];
    for (const uint a : {before.x, before.y, before.z})
        for (const uint b : {triangle.x, triangle.y, triangle.z}) shared += mesh.positions[a] == mesh.positions[b];
    return shared == 2;
}

// Collects lights first; shares follow when all are known.
struct Collector {
    const Scene& scene;
    LocalLights lights = {};
    std::vector<double> weights = {};      // by index of a light: an estimate of its power
    std::vector<double> areas = {};        // of the emitters
    std::vector<PlacedLight> placed = {};  // all but suns and lights without power

    void add_instance(uint index) {
        const Instance& instance = scene.instances[index];
        const Mesh& mesh = scene.meshes[instance.mesh];
        for (uint primitive = 0; primitive < mesh.triangles.size(); ++primitive) {
            const uint material_index = instance.material.value_or(mesh.material(primitive));
            const Material& material = scene.materials[material_index];
            if (material.unlit || largest(material.emission) <= 0) continue;
            add_emitter({index, primitive, material_index}, mesh, instance.transform, material);
        }
    }

    void add_emitter(const Emitter& emitter, const Mesh& mesh, const Transform& transform, const Material& material) {
        const uvec3& triangle = mesh.triangles[emitter.primitive];
        const vec3 a = transform_point(transform, mesh.positions[triangle.x]),
                   b = transform_point(transform, mesh.positions[triangle.y]),
                   c = transform_point(transform, mesh.positions[triangle.z]);
        const dvec3 normal = cross(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a)) * 0.5;
        const double area = length(normal);
        if (!(area > 0) || !std::isfinite(area)) return;
        const double radiance =
            luminance(material.emission) * mean_texture(scene, material.emission_texture, mesh, triangle);
        const double front = determinant(transform) < 0 ? -1 : 1;
        place({.lo = min(a, min(b, c)),
               .hi = max(a, max(b, c)),
               .axis = vec3(normal * (front / area)),
               .power = static_cast<float>(radiance * area),
               .axes_angle = 0,
               .reach_angle = double{PI} / 2,
               .is_two_sided = material.double_sided,
               .light = static_cast<uint>(weights.size())},
              emitter, triangle);
        lights.emitters.push_back(emitter);
        areas.push_back(area);
        weights.push_back(double{PI} * area * radiance * (material.double_sided ? 2 : 1));
    }

    // The second half of a quadrilateral is placed with the first.
    void place(const PlacedLight& light, const Emitter& emitter, const uvec3& triangle) {
        if (!lights.emitters.empty() && placed.back().count == 1) {
            PlacedLight& last = placed.back();
            const Emitter& before = lights.emitters.back();
            const Mesh& mesh = scene.meshes[scene.instances[emitter.instance].mesh];
            const bool is_next = before.instance == emitter.instance && before.primitive + 1 == emitter.primitive &&
                                 before.material == emitter.material;
            if (is_next && dot(last.axis, light.axis) > flat_cosine && have_an_edge(mesh, before.primitive, triangle)) {
                last.lo = min(last.lo, light.lo);
                last.hi = max(last.hi, light.hi);
                last.power += light.power;
                last.count = 2;
                return;
            }
        }
        placed.push_back(light);
    }

    void add_punctual(const Light& light, float scene_radius) {
        const float inner = std::cos(light.inner_cone), outer = std::cos(light.outer_cone);
        const float scale = 1 / std::max(inner - outer, 1e-3f);
        const bool is_spot = light.kind == Light::Kind::spot, is_sun = light.kind == Light::Kind::directional;
        const float power = luminance(light.color);
        if (!is_sun && power > 0)
            placed.push_back(
                {.lo = light.position,
                 .hi = light.position,
                 .axis = light.direction,
                 .power = power,
                 .axes_angle = is_spot ? std::min(light.inner_cone, light.outer_cone) : double{PI},
                 .reach_angle = is_spot ? std::max(double{light.outer_cone} - light.inner_cone, 0.0) : double{PI} / 2,
                 .is_two_sided = false,
                 .light = static_cast<uint>(weights.size())});
        lights.has_suns |= is_sun && power > 0;
        lights.punctual.push_back({light.position,
                                   is_sun    ? PUNCTUAL_DIRECTIONAL
                                   : is_spot ? PUNCTUAL_SPOT
                                             : PUNCTUAL_POINT,
                                   light.direction, light.range, light.color, 0, scale, -outer * scale});
        const float solid_angle = is_spot ? 2 * PI * (1 - outer) : 4 * PI;
        weights.push_back(double{power} * double{is_sun ? PI * scene_radius * scene_radius : solid_angle});
    }

    bool is_sun(std::size_t light) const {
        return light >= areas.size() && lights.punctual[light - areas.size()].kind == PUNCTUAL_DIRECTIONAL;
    }

    // The suns and the other lights have equal shares of a table of all.
    void share_by_kind() {
        double of_suns = 0, of_placed = 0;
        for (std::size_t i = 0; i < weights.size(); ++i) (is_sun(i) ? of_suns : of_placed) += weights[i];
        for (std::size_t i = 0; i < weights.size(); ++i)
            if (const double of_kind = is_sun(i) ? of_suns : of_placed; of_kind > 0) weights[i] /= of_kind;
    }

    // Makes one part of the table. Its weights become chances.
    void make_part(std::size_t first, std::size_t count) {
        const std::span part = std::span(weights).subspan(first, count);
        std::ranges::copy(make_alias_table(part), lights.table.begin() + static_cast<std::ptrdiff_t>(first));
        const double total = std::accumulate(part.begin(), part.end(), 0.0);
        for (double& weight : part) weight = total > 0 ? weight / total : 0;
    }

    void make_parts() {
        const bool has_tree = lights.by == LightChoice::tree;
        std::size_t first = 0;
        while (has_tree && first < weights.size() && !is_sun(first)) ++first;
        lights.table.resize(weights.size());
        lights.table_first = first < weights.size() ? static_cast<uint>(first) : 0;
        lights.table_count = static_cast<uint>(weights.size() - first);
        if (!has_tree) share_by_kind();
        make_part(first, weights.size() - first);
        if (!has_tree) return;
        for (const PlacedLight& light : placed) make_part(light.light, light.count);
        lights.tree = build_light_tree(placed, weights.size());
        if (lights.has_placed) lights.table_chance = lights.has_suns ? 0.5f : 0.0f;
    }

    void finish() {
        lights.has_placed = !placed.empty();
        make_parts();
        lights.densities.resize(scene.instances.size());
        lights.ways.resize(scene.instances.size());
        for (std::size_t i = 0; i < lights.emitters.size(); ++i) {
            const Emitter emitter = lights.emitters[i];
            const std::size_t count = scene.meshes[scene.instances[emitter.instance].mesh].triangles.size();
            lights.densities[emitter.instance].resize(count);
            lights.densities[emitter.instance][emitter.primitive] = static_cast<float>(weights[i] / areas[i]);
            if (lights.by != LightChoice::tree) continue;
            lights.ways[emitter.instance].resize(count);
            lights.ways[emitter.instance][emitter.primitive] = lights.tree.ways[i];
        }
        for (std::size_t i = 0; i < lights.punctual.size(); ++i)
            lights.punctual[i].chance = static_cast<float>(weights[areas.size() + i]);
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

Collector collect(const Scene& scene) {
    Collector collector{scene};
    for (uint i = 0; i < scene.instances.size(); ++i) collector.add_instance(i);
    const float radius = 0.5f * length(bounds_of(scene).size());
    for (const bool are_suns : {false, true})
        for (const Light& light : scene.lights)
            if ((light.kind == Light::Kind::directional) == are_suns) collector.add_punctual(light, radius);
    return collector;
}

LocalLights finished(Collector collector, LightChoice by) {
    collector.lights.by = by;
    collector.finish();
    return std::move(collector.lights);
}

}  // namespace

std::vector<AliasEntry> make_alias_table(std::span<const double> weights) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(total > 0)) return {};
    const auto count = static_cast<uint>(weights.size());
    std::vector<double> height(count);
    std::vector<uint> low, high;
    for (uint i = 0; i < count; ++i) {
        height[i] = weights[i] / total * count;
        (height[i] < 1 ? low : high).push_back(i);
    }
    // Columns that rounding leaves over on either list are full.
    std::vector<AliasEntry> table(count);
    for (uint i = 0; i < count; ++i) table[i] = {word_of(1), i};
    while (!low.empty() && !high.empty()) {
        const uint under = low.back(), over = high.back();
        low.pop_back();
        table[under] = {word_of(height[under]), over};
        height[over] -= 1 - height[under];
        if (height[over] < 1) {
            high.pop_back();
            low.push_back(over);
        }
    }
    // A column that must never be chosen must not be left over.
    for (const uint i : low)
        if (weights[i] == 0)
            table[i] = {0, static_cast<uint>(std::max_element(weights.begin(), weights.end()) - weights.begin())};
    return table;
}

std::vector<SetKey> LightSet::put(const LocalLights& lights) {
    put_all(set_, emitters_, lights.emitters);
    put_all(set_, punctual_, lights.punctual);
    set_.sync();
    const auto count = [](const auto& list) { return static_cast<std::ptrdiff_t>(list.size()); };
    std::vector<SetKey> keys(emitters_.begin(), emitters_.begin() + count(lights.emitters));
    keys.insert(keys.end(), punctual_.begin(), punctual_.begin() + count(lights.punctual));
    return keys;
}

LocalLights collect_lights(const Scene& scene, LightChoice by) { return finished(collect(scene), by); }

LocalLights collect_lights(const Scene& scene) {
    Collector collector = collect(scene);
    const LightChoice by = collector.placed.size() > 1 ? LightChoice::tree : LightChoice::table;
    return finished(std::move(collector), by);
}

bool has_lamps(const Scene& scene) {
    const std::vector<bool> used = used_materials(scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        if (used[i] && largest(scene.materials[i].emission) > 1) return true;
    return !scene.lights.empty();
}

std::vector<std::string> stopped_lights(const Scene& scene) {
    std::vector<std::string> sentences;
    if (scene.lights.empty()) return sentences;
    const std::vector<bool> used = used_materials(scene);
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        if (!used[i] || !may_be_other_glass(material)) continue;
        const char* why = material.thickness > 0 ? "the boundary of a volume bends it" : "rough glass scatters it";
        sentences.push_back(text("light of ", names_of(scene.lights), " cannot pass material '", material.name,
                                 "': ", why, ", and no path can reach a light without size"));
    }
    return sentences;
}

}  // namespace twinray::path_tracer
