// SPDX-License-Identifier: MIT
// A path of light and its continuation at a surface: one text for C++ and for kernels.
#ifndef TUTORIALS_PATH_H
#define TUTORIALS_PATH_H
#include "twinray/glsl/random.h"
#include "twinray/glsl/sampling.h"
#include "twinray/glsl/spawn.h"

// [room]
const uint DIFFUSE = 0u;  // reflects light in all directions, by Lambert's law
const uint MIRROR = 1u;
const uint LAMP = 2u;  // reflects nothing, and shines from its front

struct Look {
    vec3 color;  // the part of light that is reflected
    uint kind;
};

// Masks of instances. Solid ones block the lamp's light.
const uint SOLID_MASK = 1u;
const uint LAMP_MASK = 2u;

// A parallelogram, which shines along cross(u, v).
struct Lamp {
    vec3 corner;
    vec3 u;
    vec3 v;
    vec3 radiance;
};

// The viewpoint of the picture: twinray's ImagePlane.
struct Eye {
    vec3 origin;
    vec3 right;
    vec3 up;
    vec3 forward;
};

struct Room {
    Look looks[8];  // by the custom index of an instance
    Lamp lamp;
    Eye eye;
};
BUFFER_OF(Room, 4);

// [path]
struct Path {
    vec3 weight;        // how much of the light that comes along the ray reaches the pixel
    uint pixel;         // that it belongs to,
    uint sample_index;  // as which of its paths
    uint bounce;        // how many surfaces it has met
    uint sees_lamp;     // 1: from the eye or off a mirror; the lamp's light was not asked for where it started
};

// Returns four random numbers in [0, 1), different for each path, bounce and use.
FUNC vec4 random_of(Path path, uint use) {
    uvec4 words = random_words(uvec4(path.pixel, path.sample_index, path.bounce, use));
    return vec4(unit_float(words.x), unit_float(words.y), unit_float(words.z), unit_float(words.w));
}
const uint FOR_PIXEL = 0u;
const uint FOR_DIRECTIONS = 1u;
const uint FOR_ROULETTE = 2u;

// [begin]
FUNC Path begin_path(uint pixel, uint sample_index) {
    Path path;
    path.weight = vec3(1.0f, 1.0f, 1.0f);
    path.pixel = pixel;
    path.sample_index = sample_index;
    path.bounce = 0u;
    path.sees_lamp = 1u;
    return path;
}

const float EVERYWHERE = 1e30f;  // t_max

// The ray goes through a random place of its pixel. Row 0 is on top.
FUNC Ray camera_ray(Eye eye, Path path, uint width, uint height) {
    vec4 random = random_of(path, FOR_PIXEL);
    float x = 2.0f * (float(path.pixel % width) + random.x) / float(width) - 1.0f;
    float y = 1.0f - 2.0f * (float(path.pixel / width) + random.y) / float(height);
    Ray ray;
    ray.origin = eye.origin;
    ray.t_min = 0.0f;
    ray.direction = normalize(eye.forward + eye.right * x + eye.up * y);
    ray.t_max = EVERYWHERE;
    return ray;
}

// [lamp]
// The lamp's light that a diffuse surface reflects if nothing is between them, and the ray to find out: from the
// surface, at t = 0, to a random point of the lamp, at t = 1.
struct LampLight {
    vec3 light;
    Ray shadow;
};

FUNC Ray leave(SurfacePoint point, vec3 direction, float t_max) {
    Ray ray;
    ray.origin = spawn_position(point, dot(direction, point.normal) > 0.0f);
    ray.t_min = 0.0f;
    ray.direction = direction;
    ray.t_max = t_max;
    return ray;
}

FUNC LampLight lamp_light(Lamp lamp, SurfacePoint point, vec3 normal, vec2 random) {
    vec3 to_lamp = lamp.corner + lamp.u * random.x + lamp.v * random.y - point.position;
    vec3 lamp_area = cross(lamp.u, lamp.v);  // its length is the area, its direction where the lamp shines
    float squared = dot(to_lamp, to_lamp);
    // Each is a cosine times the distance; the second one also has the factor of the area.
    float cos_here = max(dot(to_lamp, normal), 0.0f);
    float cos_lamp = max(-dot(to_lamp, lamp_area), 0.0f);
    LampLight found;
    found.light = lamp.radiance * (cos_here * cos_lamp / (PI * squared * squared));
    found.shadow = leave(point, to_lamp, 1.0f);
    return found;
}

// [roulette]
// From the third surface on, a path that carries little ends, by chance. Those that go on stand for those that do not.
FUNC bool survives(INOUT(Path) path) {
    if (path.bounce < 3u) return true;
    float chance = min(max(max(path.weight.x, path.weight.y), path.weight.z), 0.95f);
    if (random_of(path, FOR_ROULETTE).x >= chance) return false;
    path.weight = path.weight / chance;
    return true;
}

// [scatter]
// The results of a path at a surface.
struct Scattering {
    vec3 seen;       // light that the pixel gets
    LampLight lamp;  // more of it, unless the shadow ray is blocked
    Ray next;        // along which the path goes on,
    uint goes_on;    // if it does
};

FUNC Scattering scatter(INOUT(Path) path, Ray ray, SurfacePoint point, Look look, Lamp lamp) {
    vec3 none = vec3(0.0f, 0.0f, 0.0f);
    Scattering found;
    found.seen = none;
    found.lamp.light = none;
    found.lamp.shadow = ray;
    found.next = ray;
    found.goes_on = 0u;
    if (look.kind == LAMP) {
        bool is_front = dot(ray.direction, cross(lamp.u, lamp.v)) < 0.0f;
        if (is_front && path.sees_lamp == 1u) found.seen = path.weight * lamp.radiance;
        return found;
    }
    vec3 normal = dot(ray.direction, point.normal) < 0.0f ? point.normal : -point.normal;
    path.bounce++;
    path.weight = path.weight * look.color;
    vec3 direction = reflect(ray.direction, normal);
    if (look.kind == DIFFUSE) {
        vec4 random = random_of(path, FOR_DIRECTIONS);
        found.lamp = lamp_light(lamp, point, normal, vec2(random.x, random.y));
        found.lamp.light = path.weight * found.lamp.light;
        direction = to_world(frame_about(normal), sample_cosine_hemisphere(vec2(random.z, random.w)));
    }
    path.sees_lamp = look.kind == MIRROR ? 1u : 0u;
    found.next = leave(point, direction, EVERYWHERE);
    found.goes_on = survives(path) ? 1u : 0u;
    return found;
}

// [args]
// The paths to trace: for each pixel first_sample, first_sample + 1, ...
struct Job {
    uint width;
    uint height;
    uint first_sample;
    uint samples;
};

// The kernel's arguments.
struct PathArgs {
    Address accel;
    REF(Room) room;
    Vec3s radiances;  // of each path, all of a sample in a row
    Job job;
};
// [/args]

// The queues of a wave in device memory.
BUFFER_OF(Path, 4);

struct DeviceQueue {
    REF(Ray) rays;
    REF(Path) paths;
    Uints count;
};

struct WaveArgs {
    Address accel;
    REF(Room) room;
    REF(Hit) hits;      // of the queue, then of the shadow rays
    Vec3s radiances;    // of each path, all of a sample in a row
    DeviceQueue queue;  // what is traced
    DeviceQueue next;
    DeviceQueue shadows;  // the weight of their paths is the light that they ask for
    uint pixels;
    uint first_sample;
};

FUNC uint place_of(WaveArgs args, Path path) {
    return (path.sample_index - args.first_sample) * args.pixels + path.pixel;
}
#endif
