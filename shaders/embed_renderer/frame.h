// SPDX-License-Identifier: MIT
// What the renderer's passes share with the host. Surfaces and materials are records of shaders/path_tracer/scene.h.
#ifndef TWINRAY_EMBED_RENDERER_FRAME_H
#define TWINRAY_EMBED_RENDERER_FRAME_H

const uint TILE = 8u;                  // kernels over pixels run in groups of TILE x TILE
const uint NO_SLOT = 0xffffffffu;      // the pixel has no rays of that kind
const uint BACKGROUND = 0xffffffffu;   // instance in the target of ids

struct FrameData
{
    REF(SurfaceInstance) instances;
    REF(VertexExtras) extras; // absent: no mesh has any
    REF(SurfaceMaterial) materials;
    TextureTable textures;
    CameraRays camera;
    float near;          // in units of camera.forward
    vec3 sun_direction;  // unit, towards the sun
    float sun_spread;    // tangent of half its angle; 0: hard shadows
    vec3 sun;            // what a white surface that faces it reflects
    vec3 sky;            // the same of the sky
    float ao_radius;     // world
    uint width;
    uint height;
    uint shadow_rays;    // per pixel
    uint ao_rays;
    uint reserved;
};
BUFFER_OF(FrameData, 8);

struct RasterArgs
{
    REF(FrameData) frame;
};

// Balls on a circle around the scene, bobbing.
struct MoveArgs
{
    REF(SurfaceInstance) instances; // the first ball, for the rasteriser
    REF(InstanceRecord) records;    // the first ball, in the accelerator
    vec3 center;
    float orbit;
    float radius;
    float turns;
    uint count;
};

// How many rays the pixels have asked for; kernels count, traces read.
struct RayCounts
{
    uint shadow;
    uint ao;
};
BUFFER_OF(RayCounts, 4);

// Where in the lists of rays and hits the rays of a pixel begin, or NO_SLOT.
struct PixelRays
{
    uint shadow;
    uint ao;
};
BUFFER_OF(PixelRays, 4);

struct RaysArgs
{
    REF(FrameData) frame;
    REF(RayCounts) counts;
    REF(PixelRays) pixels;
    REF(Ray) shadow_rays;
    REF(Ray) ao_rays;
};

struct Color
{
    vec3 rgb;
};
BUFFER_OF(Color, 4);

struct CompositeArgs
{
    REF(FrameData) frame;
    REF(PixelRays) pixels;
    REF(Hit) shadow_hits;
    REF(Hit) ao_hits;
    REF(Color) colors;
};
#endif
