// SPDX-License-Identifier: MIT
// Gathers a vertex and a triangle per invocation. Triangles that are missing or name a missing vertex lose their area.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/gather_mesh.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { GatherMeshArgs args; };

uint load_16_bits(Address base, uint index) {
    Address at = address_at(base, index, 2u);
    uint word = AT(Uints(Address(at.x & ~3u, at.y)), 0);
    return (at.x & 2u) == 0u ? word & 0xffffu : word >> 16u;
}

float component(Address vertex, uint i) {
    if (args.vertex_format == VERTEX_FLOAT32) return AT(Floats(vertex), i);
    uint bits = load_16_bits(vertex, i);
    return args.vertex_format == VERTEX_FLOAT16 ? float_of_half(bits) : float_of_snorm16(bits);
}

uint vertex_of(uint corner) {
    if (args.index_format == INDEX_NONE) return corner;
    if (args.index_format == INDEX_UINT16) return load_16_bits(args.indices, corner);
    return AT(Uints(args.indices), corner);
}

uvec3 triangle(uint index) {
    uint count = is_absent(args.count_on_device) ? args.triangle_count : AT(args.count_on_device, 0);
    if (index >= count) return uvec3(0u);
    uvec3 vertices = uvec3(vertex_of(3u * index), vertex_of(3u * index + 1u), vertex_of(3u * index + 2u));
    if (all(lessThan(vertices, uvec3(args.vertex_count)))) return vertices;
    atomicAdd(AT(args.faulty, 0), 1u);
    return uvec3(0u);
}

void main() {
    uint index = global_index();
    if (index < args.vertex_count) {
        Address vertex = address_at(args.positions, index, args.stride);
        AT(Vec3s(args.to_positions.address), index) =
            vec3(component(vertex, 0u), component(vertex, 1u), component(vertex, 2u)) * args.factor;
    }
    if (index < args.triangle_count) AT(Uvec3s(args.to_indices.address), index) = triangle(index);
}
