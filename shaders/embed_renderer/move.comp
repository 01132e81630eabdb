// SPDX-License-Identifier: MIT
// Moves the balls: the same transform goes to the rasteriser's instances and to the accelerator's.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/embed_renderer/includes.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { MoveArgs args; };

void main()
{
    uint i = global_index();
    if (i >= args.count) return;
    float phase = float(i) / float(args.count);
    vec2 circle = unit_circle(phase + args.turns);
    float height = args.radius * (1.5 + unit_circle(3.0 * phase + 2.0 * args.turns).y);
    vec3 at = args.center + vec3(circle.x * args.orbit, height, circle.y * args.orbit);
    Rows rows;
    rows.r0 = vec4(args.radius, 0.0, 0.0, at.x);
    rows.r1 = vec4(0.0, args.radius, 0.0, at.y);
    rows.r2 = vec4(0.0, 0.0, args.radius, at.z);
    AT(args.records, i).object_to_world = rows;
    AT(args.instances, i).object_to_world = rows;
    AT(args.instances, i).world_to_object = inverse_of(rows);
}
