// SPDX-License-Identifier: MIT
// Samples light: the environment, emissive triangles, punctual lights.
#ifndef TWINRAY_PATH_TRACER_LIGHTS_GLSL
#define TWINRAY_PATH_TRACER_LIGHTS_GLSL
#include "shaders/path_tracer/light_tree.h"

struct LightSample {
    vec3 direction;  // from the surface; unit
    vec3 radiance;
    float pdf;      // by solid angle; for a punctual light only its chance of being chosen
    bool is_delta;  // a punctual light, which no other strategy finds
    vec3 target;    // the end of the shadow ray; an environment has no end
    bool has_target;
};

// Chooses one of `count` lights from the first on. The fraction of word * count decides between a column's two entries.
uint sample_alias(REF(AliasEntry) table, uint first, uint count, uint word) {
    uint column, fraction;
    umulExtended(word, count, column, fraction);
    AliasEntry entry = AT(table, first + column);
    return first + (fraction < entry.probability ? column : entry.alias);
}

// Returns the cell of a table of cumulated probabilities that u in [0, 1) falls into, plus how far into it.
float sample_sums(Floats sums, uint first, uint count, float u) {
    uint low = 0u;
    uint high = count;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (AT(sums, first + middle) <= u)
            low = middle;
        else
            high = middle;
    }
    float begin = AT(sums, first + low);
    float inside = (u - begin) / (AT(sums, first + low + 1u) - begin);
    return float(low) + clamp(inside, 0.0, 0.99999994);
}

vec3 environment_pixel(Environment env, int x, int y) {
    uint column = x < 0 ? env.width - 1u : (x >= int(env.width) ? 0u : uint(x));
    return AT(env.pixels, uint(clamp(y, 0, int(env.height) - 1)) * env.width + min(column, env.width - 1u)).rgb;
}

// Returns the filtered map as seen. As light it is constant in each pixel, since it is sampled so: near a sun a
// filtered value could exceed the density of its own pixel a hundred times; such samples are bright dots.
// at: in pixels.
vec3 environment_seen(Environment env, vec2 at) {
    vec2 low = floor(at - 0.5);
    vec2 weight = at - 0.5 - low;
    int x = int(low.x);
    int y = int(low.y);
    vec3 top = mix(environment_pixel(env, x, y), environment_pixel(env, x + 1, y), weight.x);
    vec3 bottom = mix(environment_pixel(env, x, y + 1), environment_pixel(env, x + 1, y + 1), weight.x);
    return mix(top, bottom, weight.y);
}

// Returns the position in pixels; u grows from -x over -z, +x to +z.
vec2 environment_position(Environment env, vec3 direction) {
    float turns = atan(direction.z, direction.x) / (2.0 * PI) + 0.5;
    float angle = atan(length(direction.xz), direction.y) / PI;
    return vec2(turns * float(env.width), angle * float(env.height));
}

float environment_pdf(Environment env, vec3 pixel) { return env.chance * env.density_per_luminance * luminance(pixel); }

LightSample sample_environment(Environment env, vec2 u) {
    float y = sample_sums(env.row_sums, 0u, env.height, u.y);
    uint row = min(uint(y), env.height - 1u);
    float x = sample_sums(env.column_sums, row * (env.width + 1u), env.width, u.x);
    uint column = min(uint(x), env.width - 1u);
    // Uniform by solid angle between the cosines of the row's edges.
    float top = unit_circle(float(row) / float(2u * env.height)).x;
    float bottom = unit_circle(float(row + 1u) / float(2u * env.height)).x;
    float cosine = mix(top, bottom, y - float(row));
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    vec2 circle = unit_circle(x / float(env.width) - 0.5);
    LightSample light;
    light.direction = vec3(circle.x * sine, cosine, circle.y * sine);
    light.radiance = AT(env.pixels, row * env.width + column).rgb;
    light.pdf = environment_pdf(env, light.radiance);
    light.is_delta = false;
    light.has_target = false;
    light.target = vec3(0.0);
    return light;
}

// chance: that of the environment's place and the tree, which the densities of lights leave out.
LightSample sample_local(SceneData scene, Emitter emitter, float chance, vec3 from, vec2 u) {
    Placement placement = load_placement(scene.instances, emitter.instance);
    TriangleData data = load_triangle_data(scene, emitter.instance, emitter.primitive);
    data.material = emitter.material;
    Surface surface = surface_at(data, placement, sample_triangle(u));
    uint flags = AT(scene.materials, emitter.material).flags;
    float density = AT(AT(scene.instances, emitter.instance).emitter_density, emitter.primitive);
    vec3 way = surface.point.position - from;
    float distance2 = dot(way, way);
    float cosine = -dot(surface.point.normal, way) * inversesqrt(distance2);
    LightSample light;
    light.direction = way * inversesqrt(distance2);
    light.radiance = emitted(scene, emitter.material, flags, surface.uv, cosine > 0.0);
    if (HAS_ALPHA)
        light.radiance *=
            opacity(flags, AT(scene.materials, emitter.material).alpha_cutoff, base_color(scene, surface, flags).a);
    light.pdf = chance * density * distance2 / abs(cosine);
    light.is_delta = false;
    light.has_target = true;
    light.target = spawn_position(surface.point, cosine > 0.0);
    return light;
}

LightSample sample_local(SceneData scene, PunctualLight light, float chance, vec3 from, vec2 u) {
    LightSample result;
    result.pdf = chance * light.chance;
    result.is_delta = true;
    result.has_target = light.kind != PUNCTUAL_DIRECTIONAL;
    result.target = light.position;
    result.radiance = light.color;
    result.direction = -light.direction;
    if (light.kind == PUNCTUAL_DIRECTIONAL) return result;
    vec3 way = light.position - from;
    float distance2 = dot(way, way);
    result.direction = way * inversesqrt(distance2);
    float reach = distance2 / (light.range * light.range);
    result.radiance *= clamp(1.0 - reach * reach, 0.0, 1.0) / distance2;
    if (light.kind == PUNCTUAL_SPOT) {
        float cone = clamp(dot(light.direction, -result.direction) * light.cone_scale + light.cone_offset, 0.0, 1.0);
        result.radiance *= cone * cone;
    }
    return result;
}

// Kernels with every feature also see scenes without a tree, whose lights are all in the table.
bool has_tree(SceneData scene) { return HAS_LIGHT_TREE && scene.table_chance < 1.0; }

struct ChosenLight {
    uint light;
    float chance;  // without its chance in its part of the table
};

// Chooses a light. u in [0, 1): between the tree and the lights that are not in it. word: among these.
ChosenLight choose_local(SceneData scene, LightReceiver at, float u, uint word) {
    ChosenLight chosen;
    uint first = scene.table_first;
    uint count = scene.table_count;
    chosen.chance = HAS_LIGHT_TREE ? scene.table_chance : 1.0;
    if (has_tree(scene) && u >= scene.table_chance) {
        ChosenLeaf leaf = choose_leaf(scene.light_tree, at, unit_float(word));
        first = leaf.first;
        count = leaf.count;
        chosen.chance = leaf.chance * (1.0 - scene.table_chance);
        word = uint(leaf.rest * 4294967296.0);
    }
    chosen.light = sample_alias(scene.light_table, first, count, word);
    return chosen;
}

// choice: between the environment, the lights of the table and those of the tree, then among these. u: on the light.
LightSample sample_light(SceneData scene, LightReceiver at, uvec2 choice, vec2 u) {
    float environment = HAS_ENVIRONMENT ? scene.environment.chance : 0.0;
    float which = unit_float(choice.x);
    if (HAS_ENVIRONMENT && (!HAS_LOCAL_LIGHTS || which < environment)) return sample_environment(scene.environment, u);
    ChosenLight chosen = choose_local(scene, at, (which - environment) / (1.0 - environment), choice.y);
    chosen.chance *= 1.0 - environment;
    SetKey key = AT(scene.light_keys, chosen.light);
    LightSample light;
    // It stays 0 where all lights have gone out, for a key that names nothing, and where no light of the tree arrives.
    light.pdf = 0.0;
    if (!(chosen.chance > 0.0)) return light;
#define SAMPLE_LOCAL(element) light = sample_local(scene, element, chosen.chance, at.position, u)
    WITH_INDEX(LOCAL_LIGHTS, scene.lights, key, SAMPLE_LOCAL)
    return light;
}

// Returns the density with which sample_light would have found this point of an emitter.
float emitter_pdf(SceneData scene, Hit hit, Surface surface, LightReceiver at, vec3 direction) {
    SurfaceInstance instance = AT(scene.instances, hit.instance_index);
    if (is_absent(instance.emitter_density)) return 0.0;
    vec3 way = surface.point.position - at.position;
    float chance = 1.0 - scene.environment.chance;
    if (has_tree(scene))
        chance *= (1.0 - scene.table_chance) *
                  chance_of_way(scene.light_tree, at, AT(instance.emitter_ways, hit.primitive_index));
    return chance * AT(instance.emitter_density, hit.primitive_index) * dot(way, way) /
           abs(dot(surface.point.normal, direction));
}
#endif
