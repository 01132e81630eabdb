// SPDX-License-Identifier: MIT
// Shades the hits of a wave's rays, all or those of one queue: adds the light they found, sends shadow rays to lights
// and continues the paths.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/path_tracer/includes.glsl"
#include "shaders/path_tracer/path.glsl"
layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { ShadeArgs args; };

// The end of shadow rays to a point of a light, as a fraction of their way: 16 roundings before it. The point is clear
// of its triangle, but its way from here is rounded, and a ray that went all of it could meet a light that is small for
// its distance.
const float SHADOW_END = 1.0 - 9.5367431640625e-07;
const uint ROULETTE_DEPTH = 3u;  // scatterings before which no path is ended

// The pairs of random dimensions of a vertex; pair 0 of a path is its position in the pixel.
const uint PAIR_PART = 0u;     // whether a transparent surface is met, and which part of its material
const uint PAIR_CHOICE = 1u;   // of a light
const uint PAIR_LIGHT = 2u;    // on the light
const uint PAIR_SCATTER = 3u;  // direction
const uint PAIR_LOBE = 4u;     // of the BSDF, and Russian roulette
const uint PAIR_COUNT = 5u;

// A vertex of a path, shared by the functions below.
struct Vertex {
    PathState path;
    Surface surface;
    Bsdf bsdf;
    vec3 wo;
    vec3 normal;    // shading normal on the side of wo
    bool is_front;  // of the triangle
    uint facing;    // see packed_facing
    uint key;       // of the pixel's random numbers
    uint number;    // it has PAIR_COUNT pairs of random dimensions
};

float infinity() { return uintBitsToFloat(0x7f800000u); }

uvec2 pair_of(Vertex vertex, uint which) {
    return sample_pair(vertex.key, args.sample_index, PAIR_COUNT * vertex.number + which + 1u, args.seed);
}

void add_emission(Vertex vertex, Ray ray, Hit hit, uint flags) {
    vec3 radiance = emitted(AT(wave.scene, 0), vertex.surface.material, flags, vertex.surface.uv, vertex.is_front);
    if (!HAS_LOCAL_LIGHTS || largest(radiance) <= 0.0) return;
    float other =
        emitter_pdf(AT(wave.scene, 0), hit, vertex.surface, receiver_of(ray.origin, vertex.path.facing), ray.direction);
    add(vertex.path.pixel, vertex.path.throughput * radiance * found_weight(vertex.path.pdf, other));
}

// Continues the same ray behind a surface that is transparent here, or a pane. Shadow rays also pass these, so that the
// light that the ray finds still counts as found by its last scattering.
void pass(Vertex vertex, Ray ray) {
    vertex.path.progress = with_surface_met(vertex.path.progress);
    go_on(behind(ray, vertex.surface), vertex.path);
}

bool is_above(Vertex vertex, vec3 direction) {
    return (dot(vertex.surface.point.normal, direction) > 0.0) == vertex.is_front;
}

// Returns the medium in which a ray in the local direction wi starts; 0: none.
uint medium_towards(Vertex vertex, vec3 wi) {
    if (!HAS_MEDIA) return 0u;
    if (!has_layer(vertex.bsdf, LAYER_VOLUME) || wi.z > 0.0) return vertex.path.medium;
    return vertex.is_front ? vertex.surface.material + 1u : 0u;
}

// Samples a light: next-event estimation.
void light_directly(Vertex vertex) {
    SceneData scene = AT(wave.scene, 0);
    LightSample light = sample_light(scene, receiver_of(vertex.surface.point.position, vertex.facing),
                                     pair_of(vertex, PAIR_CHOICE), unit_floats(pair_of(vertex, PAIR_LIGHT)));
    if (!(light.pdf > 0.0) || !(largest(light.radiance) > 0.0)) return;
    Frame frame = frame_about(vertex.normal);
    vec3 wi = to_local(frame, light.direction);
    // A tilted shading normal must not let light through the triangle.
    if ((wi.z > 0.0) != is_above(vertex, light.direction)) return;
    BsdfValue value = evaluate(vertex.bsdf, to_local(frame, vertex.wo), wi);
    if (!(largest(value.f) > 0.0)) return;
    float weight = light.is_delta || STRATEGY == STRATEGY_LIGHTS ? 1.0 : mis_weight(light.pdf, value.pdf);
    vec3 contribution = vertex.path.throughput * value.f * light.radiance * (weight / light.pdf);
    Ray ray;
    ray.origin = spawn_position(vertex.surface.point, (wi.z > 0.0) == vertex.is_front);
    ray.direction = light.has_target ? light.target - ray.origin : light.direction;
    ray.t_min = 0.0;
    ray.t_max = light.has_target ? SHADOW_END : infinity();
    uint medium = medium_towards(vertex, wi);
    if (medium != 0u && light.has_target) contribution *= transmittance(scene, medium, length(ray.direction));
    uint slot = atomicAdd(AT(wave.counters, 0).shadows, 1u);
    AT(wave.shadow_rays, slot) = ray;
    AT(wave.shadows.contribution, slot) = contribution;
    AT(wave.shadows.pixel, slot) = vertex.path.pixel;
}

void scatter(Vertex vertex, Ray met_by) {
    vec2 lobe_and_roulette = unit_floats(pair_of(vertex, PAIR_LOBE));
    float lobe = lobe_and_roulette.x;
    vec2 u = unit_floats(pair_of(vertex, PAIR_SCATTER));
    BsdfSample onwards;
    vec3 direction;
    // A loop, because drivers inline everything, and the BSDF is most of the kernel.
    for (uint attempt = 0u; attempt < 2u; attempt++) {
        Frame frame = frame_about(vertex.normal);
        onwards = sample_bsdf(vertex.bsdf, to_local(frame, vertex.wo), lobe, u);
        direction = to_world(frame, onwards.wi);
        if (onwards.pdf != 0.0 || (onwards.wi.z > 0.0) == is_above(vertex, direction)) break;
        // A mirror direction through the triangle: mirror at the triangle itself, where losing it would be seen.
        vertex.normal = vertex.is_front ? vertex.surface.point.normal : -vertex.surface.point.normal;
        vertex.bsdf.coat_normal = vec3(0.0, 0.0, 1.0);
    }
    if ((onwards.wi.z > 0.0) != is_above(vertex, direction)) return;
    PathState path = vertex.path;
    path.throughput *= onwards.weight;
    if (is_pane(vertex.bsdf) && onwards.wi.z < 0.0) {
        vertex.path.throughput = path.throughput;
        if (largest(path.throughput) > 0.0) pass(vertex, met_by);
        return;
    }
    if (path.progress >> 16u >= args.max_depth) return;
    if (path.progress >> 16u >= ROULETTE_DEPTH) {
        // It is never less than the throughput: surviving paths would weigh more and more, and if little is absorbed
        // the mean would be that of few paths of great weight. Paths that lose nothing end at max_depth.
        float survival = min(largest(path.throughput), 1.0);
        if (lobe_and_roulette.y >= survival) return;
        path.throughput /= survival;
    }
    if (!(largest(path.throughput) > 0.0)) return;
    path.pdf = onwards.pdf;
    path.progress = with_surface_met(path.progress) + 0x10000u;
    path.medium = medium_towards(vertex, onwards.wi);
    path.facing = vertex.facing;
    Ray ray;
    ray.origin = spawn_position(vertex.surface.point, (onwards.wi.z > 0.0) == vertex.is_front);
    ray.direction = direction;
    ray.t_min = 0.0;
    ray.t_max = infinity();
    go_on(ray, path);
}

// Each pixel has one ray at a time.
void note_first(Vertex vertex, Hit hit, uint flags, vec3 albedo) {
    FirstSurface first = AT(wave.first_surfaces, vertex.path.pixel);
    first.albedo += albedo;
    first.normal += shading_normal(AT(wave.scene, 0), vertex.surface, flags, vertex.wo);
    first.distance += vertex.surface.t;
    first.count += 1u;
    if (args.sample_index == 0u) {
        first.instance = hit.instance_index + 1u;
        first.primitive = hit.primitive_index;
    }
    AT(wave.first_surfaces, vertex.path.pixel) = first;
}

void shade(PathState path, Ray ray, Hit hit) {
    Vertex vertex;
    vertex.surface = surface_of(AT(wave.scene, 0), ray, hit);
    if (HAS_MEDIA && path.medium != 0u)
        path.throughput *= transmittance(AT(wave.scene, 0), path.medium, vertex.surface.t - ray.t_min);
    vertex.path = path;
    vertex.wo = -ray.direction;
    vertex.is_front = dot(vertex.surface.point.normal, vertex.wo) >= 0.0;
    vertex.key = picture_index(wave.window, path.pixel);
    vertex.number = path.progress & 0xffffu;
    uint flags = AT(AT(wave.scene, 0).materials, vertex.surface.material).flags;
    vec2 part = unit_floats(pair_of(vertex, PAIR_PART));
    vec4 color = base_color(AT(wave.scene, 0), vertex.surface, flags);
    if (HAS_ALPHA) {
        float cutoff = AT(AT(wave.scene, 0).materials, vertex.surface.material).alpha_cutoff;
        if (part.x >= opacity(flags, cutoff, color.a)) {
            pass(vertex, ray);
            return;
        }
    }
    if (HAS_AOVS) {
        note_first(vertex, hit, flags, color.rgb);
        return;
    }
    if ((flags & MATERIAL_UNLIT) != 0u) {
        add(path.pixel, path.throughput * color.rgb);
        return;
    }
    add_emission(vertex, ray, hit, flags);
    bool is_last = path.progress >> 16u >= args.max_depth;
    if (is_last && !HAS_GLASS) return;
    vertex.normal = shading_normal(AT(wave.scene, 0), vertex.surface, flags, vertex.wo);
    vertex.bsdf = bsdf_of(AT(wave.scene, 0), vertex.surface, flags, color.rgb, vertex.is_front, part.y);
    if (LAYERS != 0u)
        set_layers(vertex.bsdf, AT(wave.scene, 0), vertex.surface, vertex.normal, vertex.wo, vertex.is_front);
    if (is_last && !is_pane(vertex.bsdf)) return;  // panes are passed at any depth, as by shadow rays
    vertex.facing = 0u;
    vec3 outside = vertex.surface.point.normal * (vertex.is_front ? 1.0 : -1.0);
    if (HAS_LIGHT_TREE) vertex.facing = packed_facing(outside, vertex.bsdf.is_glass);
    bool samples_lights = STRATEGY != STRATEGY_BSDF && (HAS_ENVIRONMENT || HAS_LOCAL_LIGHTS);
    if (samples_lights && !is_last && scatters(vertex.bsdf)) light_directly(vertex);
    scatter(vertex, ray);
}

void main() {
    wave = AT(args.wave, 0);
    uint i = global_index();
    uint count = args.count;
    if (HAS_QUEUES) count = AT(wave.kinds, args.kind).count;
    if (i >= count) return;
    if (HAS_QUEUES) i = AT(wave.queues, args.kind * wave.capacity + i);
    PathState path = load_path(i);
    Ray ray = AT(wave.rays, i);
    Hit hit = AT(wave.hits, i);
    if (HAS_QUEUES || hit.hit != 0u)
        shade(path, ray, hit);
    else
        add_environment(path, ray);
}
