// A driver that is broken at a known rate: it refuses a share of the hits, chosen by their values.
#include "twinray/glsl/program.h"

bool intersect_primitive(Candidate candidate, Ray ray_local, inout float t, inout vec2 uv) { return false; }

// Jarzynski and Olano (2020), pcg3d.
uvec3 scrambled(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// user_data holds the share, times 2^32, and a seed.
bool accept_hit(Candidate candidate, float t, vec2 uv) {
    uint share = AT(Uints(candidate.user_data), 0), seed = AT(Uints(candidate.user_data), 1);
    uvec3 bits = uvec3(floatBitsToUint(t), floatBitsToUint(uv.x) ^ candidate.primitive_index, floatBitsToUint(uv.y));
    bits.z += seed;
    return scrambled(bits).x >= share;
}
