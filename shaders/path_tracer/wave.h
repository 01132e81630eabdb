// SPDX-License-Identifier: MIT
// A wave: rays in flight, what each carries, and what the kernels that move it take. Needs ray.h and scene.h.
#ifndef TWINRAY_PATH_TRACER_WAVE_H
#define TWINRAY_PATH_TRACER_WAVE_H

const uint PATH_GROUP = 64u;

// Transparent surfaces that one path, and one shadow ray, may pass; beyond it they count as opaque and black.
const uint MAX_PASSES = 32u;
const uint MAX_SHADOW_PASSES = 8u;

// 24 bytes, one per ray.
struct PathState
{
    vec3 throughput;
    float pdf;     // density by solid angle with which the ray was sampled; 0: it could not have been found as light
    uint pixel;    // of the film
    uint progress; // low half: surfaces met, which number the random dimensions; high half: scatterings of them
};
BUFFER_OF(PathState, 8);

// What a shadow ray adds to its pixel if nothing blocks it.
struct ShadowState
{
    vec3 contribution;
    uint pixel;
};
BUFFER_OF(ShadowState, 8);

struct Counters
{
    uint paths;      // appended for the next wave
    uint shadows;    // appended for the next shadow wave
    uint non_finite; // contributions dropped as NaN or infinite
    uint cut;        // rays ended after passing too many transparent surfaces
};
BUFFER_OF(Counters, 4);

// Where the pixels of a film lie in the whole picture. Random numbers belong to pixels of the whole picture, so that a
// part of it is the same when it is rendered alone.
struct FilmWindow
{
    uint width;         // of the film
    uint picture_width;
    uint first;         // index of the film's first pixel in the picture
};
FUNC uint picture_index(FilmWindow window, uint pixel)
{
    return window.first + pixel + (pixel / window.width) * (window.picture_width - window.width);
}

// What the camera rays of a pixel see first, summed over them.
struct FirstSurface
{
    vec3 albedo;    // base color
    vec3 normal;    // for shading, in world space, on the side of the camera
    float distance; // from the camera
    uint count;     // of the rays that see something
    uint instance;  // 1 + that of sample 0; 0: it sees nothing
    uint primitive;
};
BUFFER_OF(FirstSurface, 8);

struct ShadeArgs
{
    REF(SceneData) scene;
    REF(Ray) rays;
    REF(Hit) hits;
    REF(PathState) paths;
    REF(Ray) next_rays;
    REF(PathState) next_paths;
    REF(Ray) shadow_rays;
    REF(ShadowState) shadows;
    REF(Counters) counters;
    REF(Radiance) sums;
    uint count;
    uint sample_index;
    uint seed;
    uint max_depth;
    FilmWindow window;
    REF(FirstSurface) first_surfaces; // one per pixel; null without PT_HAS_AOVS
};

struct ShadowArgs
{
    REF(SceneData) scene;
    REF(Ray) rays;
    REF(Hit) hits;
    REF(ShadowState) shadows;
    REF(Ray) next_rays;
    REF(ShadowState) next_shadows;
    REF(Counters) counters;
    REF(Radiance) sums;
    uint count;
    uint is_last; // rays that are not through after this round end
};

// A ray on which two accelerators name different hits.
struct Disagreement
{
    Ray ray;
    Hit first;
    Hit second;
    uint pixel;
    uint is_any; // a query for any hit: only hit or miss counts
};
BUFFER_OF(Disagreement, 8);

struct CompareArgs
{
    REF(Ray) rays;
    REF(Hit) first;
    REF(Hit) second;
    Uints pixels;       // of ray i at i * pixel_stride
    REF(Disagreement) found;
    Uints found_count;  // counts beyond the capacity too
    Uints marks;        // one per pixel, set to 1 where a ray disagrees
    uint pixel_stride;
    uint count;
    uint capacity;
    uint is_any;
};
#endif
