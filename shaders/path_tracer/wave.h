// SPDX-License-Identifier: MIT
// A wave: rays in flight, their data, and the arguments of the kernels that move it. Needs ray.h, scene.h and soa.h.
#ifndef TWINRAY_PATH_TRACER_WAVE_H
#define TWINRAY_PATH_TRACER_WAVE_H

const uint PATH_GROUP = 64u;

// The state of a ray's path. throughput: of light along it. pdf: density by solid angle with which the ray was sampled;
// 0: it could not have been found as light. pixel: of the film. progress: low half: surfaces met, modulo 2^16, which
// number the random dimensions; high half: scatterings of them.
#define PATH_FIELDS(X, P) X(P, 0, vec3, throughput) X(P, 1, float, pdf) X(P, 2, uint, pixel) X(P, 3, uint, progress)
TWINRAY_SOA_VIEW(PathQueue, PATH_FIELDS)

FUNC uint with_surface_met(uint progress) { return (progress & 0xffff0000u) | ((progress + 1u) & 0xffffu); }

// The contribution of a shadow ray to its pixel if nothing blocks it.
#define SHADOW_FIELDS(X, P) X(P, 0, vec3, contribution) X(P, 1, uint, pixel)
TWINRAY_SOA_VIEW(ShadowQueue, SHADOW_FIELDS)

// The rays of a wave that hit materials of one kind. The last three are read by an indirect dispatch.
struct KindQueue {
    uint count;
    uint groups_x;
    uint groups_y;
    uint groups_z;
};
BUFFER_OF(KindQueue, 4);

struct Counters {
    uint paths;       // appended for the next wave
    uint shadows;     // appended for the next shadow wave
    uint non_finite;  // contributions dropped as NaN or infinite
};
BUFFER_OF(Counters, 4);

// The position of the pixels of a film in the whole picture. Random numbers belong to pixels of the whole picture, so
// that a part of it is the same when it is rendered alone.
struct FilmWindow {
    uint width;  // of the film
    uint picture_width;
    uint first;  // index of the film's first pixel in the picture
};
FUNC uint picture_index(FilmWindow window, uint pixel) {
    return window.first + pixel + (pixel / window.width) * (window.picture_width - window.width);
}

// The first surfaces that the camera rays of a pixel see, summed over the rays.
struct FirstSurface {
    vec3 albedo;     // base color
    vec3 normal;     // for shading, in world space, on the side of the camera
    float distance;  // from the camera
    uint count;      // of the rays that see something
    uint instance;   // 1 + that of sample 0; 0: it sees nothing
    uint primitive;
};
BUFFER_OF(FirstSurface, 8);

// The addresses of the arrays of a wave. A wave of shadow rays has the same, with its rays in shadow_rays.
struct WaveData {
    REF(SceneData) scene;
    REF(Ray) rays;
    REF(Hit) hits;
    PathQueue paths;
    REF(Ray) next_rays;
    PathQueue next_paths;
    Uints media;         // of the paths: 1 + the material of the volume that it is in, 0: none; absent
    Uints next_media;    // without PT_HAS_MEDIA
    Uints facings;       // of the paths: how the surface lies that they left, see packed_facing; absent
    Uints next_facings;  // without PT_HAS_LIGHT_TREE
    REF(Ray) shadow_rays;
    ShadowQueue shadows;
    REF(Ray) next_shadow_rays;
    ShadowQueue next_shadows;
    REF(KindQueue) kinds;  // absent where all materials are of one kind
    Uints queues;          // for each kind, `capacity` indices of rays
    REF(Counters) counters;
    REF(Radiance) sums;
    REF(FirstSurface) first_surfaces;  // one per pixel; absent without PT_HAS_AOVS
    FilmWindow window;
    uint capacity;  // of the arrays
};
BUFFER_OF(WaveData, 8);

// Arguments of the kernels that queue the rays of a wave, and that follow shadow rays.
struct WaveArgs {
    REF(WaveData) wave;
    uint count;
};

struct ShadeArgs {
    REF(WaveData) wave;
    uint count;  // of rays; those of a queue have theirs
    uint kind;
    uint sample_index;
    uint seed;
    uint max_depth;
};

// A ray on which two accelerators name different hits.
struct Disagreement {
    Ray ray;
    Hit first;
    Hit second;
    uint pixel;
    uint is_any;  // a query for any hit: only hit or miss counts
};
BUFFER_OF(Disagreement, 8);

struct CompareArgs {
    REF(Ray) rays;
    REF(Hit) first;
    REF(Hit) second;
    Uints pixels;  // of the rays
    REF(Disagreement) found;
    Uints found_count;  // counts beyond the capacity too
    Uints marks;        // one per pixel, set to 1 where a ray disagrees
    uint count;
    uint capacity;
    uint is_any;
};
#endif
