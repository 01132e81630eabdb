// SPDX-License-Identifier: MIT
// Computes the light that the lamp sends to the camera from each hit, by the material that the instance's key names;
// then the mean of a pixel's rays.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/multi_type_set.glsl"
#include "twinray/glsl/spawn.glsl"
#include "shaders/particles/picture.h"
layout(local_size_x = 64) in;

#ifdef KERNEL_SHADE
layout(push_constant, scalar) uniform Push { ShadeArgs args; };

const float PI = 3.14159265;

struct Surface {
    vec3 color;
    float metallic;
    float roughness;  // perceptual
};

Surface surface_of(HeatMaterial material, vec3 position, vec3 normal) {
    return Surface(material.color, material.metallic, material.roughness);
}

// Squares on the wall, whatever its own coordinate rounds to.
Surface surface_of(WallMaterial material, vec3 position, vec3 normal) {
    vec3 cell = floor(position * (1.0 - abs(normal)) / material.cell);
    bool is_dark = (int(cell.x) + int(cell.y) + int(cell.z) & 1) != 0;
    return Surface(material.color * (is_dark ? 0.7 : 1.0), 0.0, 1.0);
}

// Returns a Trowbridge-Reitz lobe with height-correlated masking, and Schlick's Fresnel term, times the cosine.
vec3 reflected(Surface surface, vec3 normal, vec3 to_eye, vec3 to_lamp) {
    float cos_lamp = max(dot(normal, to_lamp), 0.0);
    float cos_eye = max(dot(normal, to_eye), 0.01);
    vec3 middle = normalize(to_eye + to_lamp);
    float cos_middle = max(dot(normal, middle), 0.0);
    float a2 = pow(surface.roughness, 4.0);
    float spread = cos_middle * cos_middle * (a2 - 1.0) + 1.0;
    float masking =
        cos_lamp * sqrt(cos_eye * cos_eye * (1.0 - a2) + a2) + cos_eye * sqrt(cos_lamp * cos_lamp * (1.0 - a2) + a2);
    vec3 mirror = mix(vec3(0.04), surface.color, surface.metallic);
    vec3 fresnel = mirror + (1.0 - mirror) * pow(1.0 - max(dot(to_eye, middle), 0.0), 5.0);
    vec3 lobe = fresnel * (a2 / (PI * spread * spread) * 0.5 / max(masking, 0.01));
    vec3 matt = surface.color * ((1.0 - surface.metallic) / PI) * (1.0 - fresnel);
    return (matt + lobe) * cos_lamp;
}

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    PictureScene scene = AT(args.scene, 0);
    Hit hit = AT(args.hits, i);
    AT(args.shadow_rays, i) = Ray(vec3(0.0), 0.0, vec3(0.0, 1.0, 0.0), 0.0);
    AT(args.light, i) = Light(scene.background, vec3(0.0));
    if (hit.hit == 0u) return;

    bool is_ball = hit.instance_index != 0u;
    MeshData mesh = scene.walls;
    if (is_ball) mesh = scene.ball;
    Placement placement = placement_of(AT(scene.instances, hit.instance_index));
    SurfacePoint point =
        surface_point(placement, vertices_of(mesh.positions, mesh.indices, hit.primitive_index), vec2(hit.u, hit.v));
    vec3 normal = is_ball ? normalize(point.position - offset_of(placement.to_world)) : point.normal;

    Surface surface = Surface(vec3(1.0, 0.0, 1.0), 0.0, 1.0);
    SetKey key = AT(scene.keys, hit.instance_index);
#define SURFACE_OF(material) surface = surface_of(material, point.position, point.normal)
    WITH_INDEX(PARTICLE_MATERIALS, args.materials, key, SURFACE_OF)

    vec3 way = scene.lamp - point.position;
    vec3 to_lamp = normalize(way);
    vec3 to_eye = -normalize(AT(args.rays, i).direction);
    vec3 direct = reflected(surface, normal, to_eye, to_lamp) * (scene.lamp_power / dot(way, way));
    AT(args.light, i) = Light(surface.color * scene.ambient * (0.75 + 0.25 * normal.y), direct);
    if (dot(to_lamp, point.normal) > 0.0 && direct != vec3(0.0))
        AT(args.shadow_rays, i) = Ray(spawn_position(point, true), 0.0, way, 1.0);
    else
        AT(args.light, i).direct = vec3(0.0);
}
#endif

#ifdef KERNEL_ADD_LIGHT
layout(push_constant, scalar) uniform Push { AddLightArgs args; };

void main() {
    uint pixel = global_index();
    if (pixel >= args.count) return;
    vec3 sum = vec3(0.0);
    for (uint i = pixel * args.samples; i < (pixel + 1u) * args.samples; i++) {
        Light light = AT(args.light, i);
        sum += light.indirect;
        if (AT(args.shadow_hits, i).hit == 0u) sum += light.direct;
    }
    AT(args.picture, pixel) = sum / float(args.samples);
}
#endif
