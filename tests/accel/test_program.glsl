// The trace program of trace_program_test.cpp: boxes are spheres, and non-opaque hits count in stripes or, for custom
// indices from 1000 on, at a smaller t.
#include "twinray/glsl/program.h"

struct Sphere {
    vec3 center;
    float radius;
};
BUFFER_OF(Sphere, 4);

bool intersect_primitive(Candidate candidate, Ray ray_local, inout float t, inout vec2 uv) {
    Sphere sphere = AT(REF(Sphere)(candidate.user_data), candidate.primitive_index);
    vec3 d = ray_local.direction;
    float a = dot(d, d);
    float t_middle = dot(sphere.center - ray_local.origin, d) / a;
    vec3 offset = ray_local.origin + t_middle * d - sphere.center;
    float square = sphere.radius * sphere.radius - dot(offset, offset);
    if (square < 0.0f) return false;
    float half_chord = sqrt(square / a);
    t = t_middle - half_chord > ray_local.t_min ? t_middle - half_chord : t_middle + half_chord;
    uv = vec2(square, float(candidate.custom_index));
    return true;
}

bool accept_hit(Candidate candidate, float t, vec2 uv) {
    if (candidate.custom_index >= 1000u) return t < float(candidate.custom_index);
    return fract(uv.x * 5.0f + float(candidate.custom_index) * 0.3f) < 0.5f;
}
