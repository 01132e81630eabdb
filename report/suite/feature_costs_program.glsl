// A trace program like a user's: spheres in boxes, and hits that count in stripes. The scenes that measure feature
// costs have neither.
#include "twinray/glsl/program.h"

bool intersect_primitive(Candidate candidate, Ray ray_local, inout float t, inout vec2 uv) {
    vec4 sphere = AT(Vec4s(candidate.user_data), candidate.primitive_index);
    vec3 d = ray_local.direction;
    vec3 to_center = sphere.xyz - ray_local.origin;
    float t_middle = dot(to_center, d) / dot(d, d);
    vec3 aside = t_middle * d - to_center;
    float square = sphere.w * sphere.w - dot(aside, aside);
    if (square < 0.0f) return false;
    t = t_middle - sqrt(square / dot(d, d));
    uv = vec2(square, 0.0f);
    return true;
}

bool accept_hit(Candidate candidate, float t, vec2 uv) { return fract(8.0f * uv.x) < 0.5f; }
