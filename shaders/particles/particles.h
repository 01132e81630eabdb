// SPDX-License-Identifier: MIT
// Particles in a box: their motion, and the colour of their speed. Read by kernels and by their serial references.
#ifndef TWINRAY_PARTICLES_PARTICLES_H
#define TWINRAY_PARTICLES_PARTICLES_H
#include "twinray/glsl/instance.h"
#include "twinray/glsl/multi_type_set.h"
#include "twinray/glsl/soa.h"

// A metal whose colour tells how fast a particle is.
struct HeatMaterial {
    vec3 color;  // linear
    float metallic;
    float roughness;
};
BUFFER_OF(HeatMaterial, 4);

// A matt wall of squares of the size `cell`.
struct WallMaterial {
    vec3 color;  // linear
    float cell;
};
BUFFER_OF(WallMaterial, 4);

#define PARTICLE_MATERIALS(X, P) X(P, 0, HeatMaterial, heat) X(P, 1, WallMaterial, wall)
TWINRAY_SET_VIEW(ParticleMaterials, PARTICLE_MATERIALS)

#define PARTICLE_FIELDS(X, P) X(P, 0, vec3, position) X(P, 1, vec3, velocity) X(P, 2, float, radius)
TWINRAY_SOA_VIEW(Particles, PARTICLE_FIELDS)

// Particle i is element i of the heat materials and of the instances.
struct MoveArgs {
    Particles particles;
    ParticleMaterials materials;
    REF(InstanceRecord) instances;
    float seconds;    // of the frame
    float gravity;    // along -y
    float bounce;     // the part of a speed that a wall gives back
    float max_speed;  // at the hot end of the colours
};

// Returns a colour from blue (t = 0) by green and yellow to white (t = 1), straight in each quarter.
FUNC vec3 heat_color(float t) {
    float quarter = min(floor(4.0f * t), 3.0f);
    float s = 4.0f * t - quarter;
    if (quarter == 0.0f) return vec3(0.1f, 0.2f + 0.5f * s, 0.8f);
    if (quarter == 1.0f) return vec3(0.1f + 0.6f * s, 0.7f, 0.8f - 0.6f * s);
    if (quarter == 2.0f) return vec3(0.7f + 0.3f * s, 0.7f - 0.4f * s, 0.2f - 0.1f * s);
    return vec3(1.0f, 0.3f + 0.7f * s, 0.1f + 0.9f * s);
}

// Makes particle i's material: the colour of its speed, and a surface of its own.
FUNC HeatMaterial heat_material(uint i, vec3 velocity, float max_speed) {
    HeatMaterial material;
    material.color = heat_color(clamp(length(velocity) / max_speed, 0.0f, 1.0f));
    float noise = 0.5f * sin(0.1f * float(i + 1u)) + 0.5f;
    material.metallic = 0.3f + 0.6f * noise;
    material.roughness = 0.2f + 0.4f * (1.0f - noise);
    return material;
}

// Position and velocity along one axis.
struct Motion {
    float position;
    float velocity;
};

// Moves by a step along an axis between walls at -1 and 1, which throw a particle back. However fast it is, it stays
// between them.
FUNC Motion moved(Motion motion, float radius, float acceleration, float seconds, float bounce) {
    PRECISE float velocity = motion.velocity + acceleration * seconds;
    PRECISE float position = motion.position + velocity * seconds;
    float limit = 1.0f - radius;
    if (abs(position) > limit) {
        float wall = position > 0.0f ? limit : -limit;
        PRECISE float beyond = position - wall;
        position = wall - bounce * beyond;
        velocity = -bounce * velocity;
    }
    motion.position = clamp(position, -limit, limit);
    motion.velocity = velocity;
    return motion;
}
#endif
