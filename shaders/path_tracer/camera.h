// SPDX-License-Identifier: MIT
// The start of camera rays, and the part of the picture that they belong to. Needs ray.h, sampling.h and wave.h.
#ifndef TWINRAY_PATH_TRACER_CAMERA_H
#define TWINRAY_PATH_TRACER_CAMERA_H

// Rays leave origin + x right + y up (orthographic) or in direction forward + x right + y up, x and y in [-1, 1].
// `forward` has length 1.
struct CameraRays {
    vec3 origin;
    vec3 right;
    vec3 up;
    vec3 forward;
    uint orthographic;
    float lens_radius;     // in world units; 0: a pinhole
    float focal_distance;  // of the plane that is sharp, along forward
};

struct GenerateArgs {
    REF(WaveData) wave;
    Uints pixels;  // of the film, in the order in which they are traced
    CameraRays camera;
    uint picture_height;
    uint count;
    uint sample_index;
    uint seed;
};

const uint FILTER_BOX = 0u;       // the pixel itself
const uint FILTER_TRIANGLE = 1u;  // one pixel to each side
const uint FILTER_GAUSSIAN = 2u;  // standard deviation half a pixel, never cut off

// Returns the position of a sample of a pixel, from the pixel's centre, in pixels. Its density is the reconstruction
// filter, so that every sample has weight 1 and no pixel shares samples with its neighbours (Ernst, Stamminger and
// Greiner, "Filter Importance Sampling", 2006). The gaussian is Box and Muller's.
FUNC vec2 filter_offset(uint filter_kind, vec2 u) {
    if (filter_kind == FILTER_BOX) return u - 0.5f;
    if (filter_kind == FILTER_GAUSSIAN) return unit_circle(u.y) * (0.5f * sqrt(max(-2.0f * log(1.0f - u.x), 0.0f)));
    vec2 root = vec2(sqrt(min(2.0f * u.x, 2.0f - 2.0f * u.x)), sqrt(min(2.0f * u.y, 2.0f - 2.0f * u.y)));
    return vec2(u.x < 0.5f ? root.x - 1.0f : 1.0f - root.x, u.y < 0.5f ? root.y - 1.0f : 1.0f - root.y);
}

// The ray goes through `at`, in [-1, 1], and the point u of the lens. Rays through one point of the picture meet on the
// focal plane (Cook, Porter and Carpenter, "Distributed Ray Tracing", 1984).
FUNC Ray camera_ray(CameraRays camera, vec2 at, vec2 u) {
    bool is_orthographic = camera.orthographic != 0u;
    vec3 across = camera.right * at.x + camera.up * at.y;
    Ray ray;
    ray.origin = camera.origin + (is_orthographic ? across : vec3(0.0f));
    ray.direction = camera.forward + (is_orthographic ? vec3(0.0f) : across);
    if (camera.lens_radius > 0.0f) {
        vec2 disk = unit_circle(u.y) * (camera.lens_radius * sqrt(u.x));
        vec3 lens = normalize(camera.right) * disk.x + normalize(camera.up) * disk.y;
        ray.origin = ray.origin + lens;
        ray.direction = ray.direction - lens / camera.focal_distance;
    }
    ray.direction = normalize(ray.direction);
    ray.t_min = 0.0f;
    ray.t_max = uintBitsToFloat(0x7f800000u);
    return ray;
}
#endif
