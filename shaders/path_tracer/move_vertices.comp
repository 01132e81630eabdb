// SPDX-License-Identifier: MIT
// Writes moved vertices, array by array, into the records of a mesh.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/path_tracer/scene.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { MoveVerticesArgs args; };

vec3 load_vec3(Floats from, uint at) { return vec3(AT(from, at), AT(from, at + 1u), AT(from, at + 2u)); }

void main()
{
    uint i = global_index();
    if (i >= args.count) return;
    AT(args.vertices, i).position = load_vec3(args.positions, 3u * i);
    if (!is_absent(args.normals)) AT(args.vertices, i).normal = load_vec3(args.normals, 3u * i);
    if (!is_absent(args.tangents))
        AT(args.vertices, i).tangent = vec4(load_vec3(args.tangents, 4u * i), AT(args.tangents, 4u * i + 3u));
}
