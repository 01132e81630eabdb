// SPDX-License-Identifier: MIT
// Moves one vertex per invocation: morph targets, then linear blend skinning.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "twinray/glsl/rays.h"
#include "twinray/glsl/transform.h"
#include "shaders/scene/deform.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { DeformArgs args; };

vec3 load_vec3(Floats from, uint at) { return vec3(AT(from, at), AT(from, at + 1u), AT(from, at + 2u)); }

void store_vec3(Floats to, uint at, vec3 value) {
    AT(to, at) = value.x;
    AT(to, at + 1u) = value.y;
    AT(to, at + 2u) = value.z;
}

vec3 displaced(vec3 value, Floats displacements, uint vertex) {
    if (is_absent(displacements)) return value;
    for (uint i = 0u; i < args.target_count; ++i) {
        float weight = AT(args.target_weights, i);
        if (weight != 0.0) value += weight * load_vec3(displacements, 3u * (i * args.vertex_count + vertex));
    }
    return value;
}

Rows blend_of(uint vertex) {
    Rows blend;
    blend.r0 = vec4(0.0);
    blend.r1 = vec4(0.0);
    blend.r2 = vec4(0.0);
    for (uint i = vertex * args.influences; i < (vertex + 1u) * args.influences; ++i) {
        float weight = AT(args.joint_weights, i);
        if (weight == 0.0) continue;  // of unused joints, which may be infinite
        uint row = 3u * AT(args.joints, i);
        blend.r0 += weight * AT(args.joint_rows, row);
        blend.r1 += weight * AT(args.joint_rows, row + 1u);
        blend.r2 += weight * AT(args.joint_rows, row + 2u);
    }
    return blend;
}

float largest_of(vec3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

vec3 unit_or_zero(vec3 v) {
    float largest = largest_of(v);
    return largest > 0.0 && is_finite(v) ? normalize(v / largest) : vec3(0.0);
}

// Returns the linear part in units of its largest entry, for directions: products of entries then stay within float.
Rows scaled(Rows m) {
    float unit = power_of_two_below(max(max(largest_of(m.r0.xyz), largest_of(m.r1.xyz)), largest_of(m.r2.xyz)));
    float factor = unit > 0.0 ? 1.0 / unit : 0.0;
    m.r0 *= factor;
    m.r1 *= factor;
    m.r2 *= factor;
    return m;
}

vec3 times_cofactors(Rows m, vec3 v) {
    return vec3(dot(cross(m.r1.xyz, m.r2.xyz), v), dot(cross(m.r2.xyz, m.r0.xyz), v),
                dot(cross(m.r0.xyz, m.r1.xyz), v));
}

void move_directions(Rows blend, bool is_skinned, uint vertex) {
    Rows m = scaled(blend);
    if (!is_absent(args.normals)) {
        vec3 normal = displaced(load_vec3(args.normals, 3u * vertex), args.target_normals, vertex);
        if (is_skinned) normal = times_cofactors(m, normal);
        store_vec3(args.moved_normals, 3u * vertex, unit_or_zero(normal));
    }
    if (!is_absent(args.tangents)) {
        vec3 tangent = displaced(load_vec3(args.tangents, 4u * vertex), args.target_tangents, vertex);
        if (is_skinned) tangent = transform_vector(m, tangent);
        store_vec3(args.moved_tangents, 4u * vertex, unit_or_zero(tangent));
        AT(args.moved_tangents, 4u * vertex + 3u) = AT(args.tangents, 4u * vertex + 3u);
    }
}

void main() {
    uint vertex = global_index();
    if (vertex >= args.vertex_count) return;
    bool is_skinned = args.influences > 0u;
    Rows blend = blend_of(vertex);
    vec3 position = displaced(load_vec3(args.positions, 3u * vertex), args.target_positions, vertex);
    if (is_skinned) position = transform_point(blend, position);
    store_vec3(args.moved_positions, 3u * vertex, position);
    move_directions(blend, is_skinned, vertex);
}
