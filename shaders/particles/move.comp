// SPDX-License-Identifier: MIT
// Moves each particle by one frame: its position, the accelerator's instance, and its material.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/particles/particles.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { MoveArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.particles.count) return;
    vec3 position = AT(args.particles.position, i);
    vec3 velocity = AT(args.particles.velocity, i);
    float radius = AT(args.particles.radius, i);
    for (int axis = 0; axis < 3; axis++) {
        float acceleration = axis == 1 ? -args.gravity : 0.0;
        Motion motion = moved(Motion(position[axis], velocity[axis]), radius, acceleration, args.seconds, args.bounce);
        position[axis] = motion.position;
        velocity[axis] = motion.velocity;
    }
    AT(args.particles.position, i) = position;
    AT(args.particles.velocity, i) = velocity;
    AT(args.instances, i).object_to_world.r0 = vec4(radius, 0.0, 0.0, position.x);
    AT(args.instances, i).object_to_world.r1 = vec4(0.0, radius, 0.0, position.y);
    AT(args.instances, i).object_to_world.r2 = vec4(0.0, 0.0, radius, position.z);
    AT(args.materials.heat, i) = heat_material(i, velocity, args.max_speed);
}
