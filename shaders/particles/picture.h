// SPDX-License-Identifier: MIT
// The picture shows a lamp, walls and particles. A frame traces the rays of the camera, shades their hits, traces a
// shadow ray for each, and adds up.
#ifndef TWINRAY_PARTICLES_PICTURE_H
#define TWINRAY_PARTICLES_PICTURE_H
#include "shaders/particles/particles.h"
#include "twinray/glsl/spawn.h"

struct MeshData {
    Floats positions;
    Uints indices;
};

struct PictureScene {
    MeshData walls;  // of instance 0
    MeshData ball;   // of the others
    REF(InstanceRecord) instances;
    REF(SetKey) keys;  // by instance: its material
    vec3 lamp;
    float lamp_power;
    vec3 background;
    float ambient;
};
BUFFER_OF(PictureScene, 8);

// The light of a ray: the part that arrives anyway, and the part that arrives if the lamp is not hidden.
struct Light {
    vec3 indirect;
    vec3 direct;
};
BUFFER_OF(Light, 4);

struct ShadeArgs {
    ParticleMaterials materials;
    REF(PictureScene) scene;
    REF(Ray) rays;
    REF(Hit) hits;
    REF(Ray) shadow_rays;  // written; those that need none are empty
    REF(Light) light;      // written
    uint count;
};

struct AddLightArgs {
    REF(Light) light;
    REF(Hit) shadow_hits;
    REF(vec3) picture;  // written
    uint count;
    uint samples;  // rays of a pixel, which follow each other
};
#endif
