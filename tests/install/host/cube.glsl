#include "twinray/glsl/program.h"

// A box whose surface halves the way to the ray's end.
bool intersect_primitive(Candidate candidate, Ray ray_local, inout float t, inout vec2 uv) {
    t = 0.5f * ray_local.t_max;
    return true;
}
bool accept_hit(Candidate candidate, float t, vec2 uv) { return true; }
