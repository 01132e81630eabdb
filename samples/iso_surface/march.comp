// SPDX-License-Identifier: MIT
// Makes triangles of a surface f = 0, one cell of a grid per invocation: each cell is cut into six tetrahedra about its
// diagonal, and each of those by a plane (marching tetrahedra: Doi, Koide 1991).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
    Floats positions;  // 3 vertices a triangle
    Floats normals;
    Uints count;  // triangles so far
    uint cells;   // along an edge of the cube from -1 to 1
    uint most;    // triangles
}
push;

// A thick gyroid, cut out of a ball, with the edges rounded off.
float field(vec3 p) {
    vec3 q = 9.0 * p;
    float gyroid = (abs(dot(sin(q), cos(q.yzx))) - 0.45) / 12.0, ball = length(p) - 0.9;
    float near_edge = max(1.0 - abs(gyroid - ball) / 0.06, 0.0);
    return max(gyroid, ball) + near_edge * near_edge * 0.015;
}

vec3 gradient(vec3 p) {
    const float h = 0.002;
    return vec3(field(p + vec3(h, 0, 0)) - field(p - vec3(h, 0, 0)),
                field(p + vec3(0, h, 0)) - field(p - vec3(0, h, 0)),
                field(p + vec3(0, 0, h)) - field(p - vec3(0, 0, h)));
}

struct Corner {
    vec3 position;
    float value;
};

Corner corner_at(uvec3 place) {
    vec3 position = 2.0 * vec3(place) / float(push.cells) - 1.0;
    return Corner(position, field(position));
}

// Returns the point with f = 0 between two corners. Neighbours give them in the same order, so that all bits agree.
vec3 crossing(Corner a, Corner b) { return mix(a.position, b.position, a.value / (a.value - b.value)); }

void add_triangle(vec3 a, vec3 b, vec3 c) {
    vec3 outwards = gradient((a + b + c) / 3.0);
    if (dot(cross(b - a, c - a), outwards) < 0.0) {
        vec3 swapped = b;
        b = c;
        c = swapped;
    }
    uint slot = atomicAdd(AT(push.count, 0), 1u);
    if (slot >= push.most) return;
    vec3 vertices[3] = vec3[3](a, b, c);
    for (uint k = 0u; k < 3u; k++) {
        AT(Vec3s(push.positions.address), 3u * slot + k) = vertices[k];
        AT(Vec3s(push.normals.address), 3u * slot + k) = gradient(vertices[k]);
    }
}

void march(Corner corners[4]) {
    uint inside[4], outside[4];
    uint insides = 0u, outsides = 0u;
    for (uint i = 0u; i < 4u; i++)
        if (corners[i].value < 0.0)
            inside[insides++] = i;
        else
            outside[outsides++] = i;
    if (insides == 0u || outsides == 0u) return;
    vec3 on_edge[4];
    uint edges = 0u;
    for (uint i = 0u; i < insides; i++)
        for (uint k = 0u; k < outsides; k++)
            on_edge[edges++] = crossing(corners[min(inside[i], outside[k])], corners[max(inside[i], outside[k])]);
    add_triangle(on_edge[0], on_edge[1], on_edge[2]);
    if (edges == 4u) add_triangle(on_edge[1], on_edge[2], on_edge[3]);
}

void main() {
    uint index = global_index(), n = push.cells;
    if (index >= n * n * n) return;
    uvec3 cell = uvec3(index % n, index / n % n, index / (n * n));
    const uvec3 axes[3] = uvec3[3](uvec3(1, 0, 0), uvec3(0, 1, 0), uvec3(0, 0, 1));
    Corner corners[4];
    corners[0] = corner_at(cell);
    corners[3] = corner_at(cell + 1u);
    for (uint first = 0u; first < 3u; first++)
        for (uint turn = 1u; turn < 3u; turn++) {
            uvec3 one = cell + axes[first];
            corners[1] = corner_at(one);
            corners[2] = corner_at(one + axes[(first + turn) % 3u]);
            march(corners);
        }
}
