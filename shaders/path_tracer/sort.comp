// SPDX-License-Identifier: MIT
// Queues the rays of a wave by the kind of their hit's material, so that each shading kernel only has the code of one
// kind and its neighbouring invocations do the same. Rays without a hit end here.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/path_tracer/includes.glsl"
#include "shaders/path_tracer/path.glsl"
layout(local_size_x = PATH_GROUP) in;
layout(push_constant, scalar) uniform Push { WaveArgs args; };

uint kind_of(SceneData scene, Hit hit) {
    SurfaceMesh mesh = AT(AT(scene.instances, hit.instance_index).mesh, 0);
    uint of_triangle = material_of_triangle(mesh, hit.primitive_index);
    return AT(scene.material_kinds, material_of(hit.custom_index, of_triangle));
}

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    wave = AT(args.wave, 0);
    Hit hit = AT(wave.hits, i);
    if (hit.hit == 0u) {
        add_environment(load_path(i), AT(wave.rays, i));
        return;
    }
    uint kind = kind_of(AT(wave.scene, 0), hit);
    uint slot = atomicAdd(AT(wave.kinds, kind).count, 1u);
    AT(wave.queues, kind * wave.capacity + slot) = i;
    if (slot % PATH_GROUP == 0u) atomicAdd(AT(wave.kinds, kind).groups_x, 1u);
}
