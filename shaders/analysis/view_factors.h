// SPDX-License-Identifier: MIT
// Rays that leave a face as diffuse radiation does, and their targets; points of a part of a face.
#ifndef TWINRAY_ANALYSIS_VIEW_FACTORS_H
#define TWINRAY_ANALYSIS_VIEW_FACTORS_H
#include "shaders/analysis/faces.h"
#include "twinray/glsl/sampling.h"
#include "twinray/glsl/sobol.h"

// Samples are drawn in as many independent sequences, whose scatter gives the error of the mean.
const uint REPLICATES = 16u;
const uint SAMPLES_OF_CHUNK = 4u;  // of each replicate
const uint CHUNK = 64u;            // rays, one invocation each: REPLICATES * SAMPLES_OF_CHUNK

// A face radiates at this distance from its edges, in offsets of its spawn points: enough for walls at 8 degrees to it.
const float EDGE_OFFSETS = 8.0f;

// Rays from one face: samples `first` to `first + SAMPLES_OF_CHUNK - 1` of each replicate. Ray i belongs to replicate i
// / SAMPLES_OF_CHUNK.
struct RayChunk {
    uint face;
    uint first;
};
BUFFER_OF(RayChunk, 8);

// The targets of rays other than faces.
const uint TARGET_OPEN = 0xffffffffu;  // nothing
const uint TARGET_BACK = 0xfffffffeu;  // a back side, where only fronts count

const uint SEQUENCE_SOBOL = 0u;
const uint SEQUENCE_RANDOM = 1u;

struct FaceRaysArgs {
    FaceTable table;
    REF(RayChunk) chunks;
    REF(Ray) rays;  // written
    uint seed;
    uint sequence;  // SEQUENCE_*
    uint is_two_sided;
    uint reserved;
};

struct FaceTargetsArgs {
    FaceTable table;
    REF(Ray) rays;
    REF(Hit) hits;
    Uints groups;   // by face; absent: each face is its own
    Uints targets;  // written: the group that each ray meets, or TARGET_*
    uint count;
    uint is_two_sided;
};

FUNC vec4 sample_of(FaceRaysArgs args, uint face, uint replicate, uint index) {
    uvec4 words;
    if (args.sequence == SEQUENCE_SOBOL)
        words = sobol_point(uvec4(face, replicate, args.seed, 1u), index);
    else
        words = random_words(uvec4(face, replicate << 28u | index, args.seed, 2u));
    return vec4(unit_floats(uvec2(words.x, words.y)), unit_floats(uvec2(words.z, words.w)));
}

// Returns a point of the face, with barycentric coordinates u, v. One nearer to an edge than some offsets is moved away
// from it: it might be rounded to the far side of a wall that meets the face at the edge, or start beyond it.
FUNC SurfacePoint inner_point(FaceTable table, uint face, vec2 uv) {
    SurfacePoint point = point_on_face(table, face, uv);
    float margin = min(EDGE_OFFSETS * point.offset / point.feature, 1.0f / 3.0f);
    vec3 inside = max(vec3(1.0f - uv.x - uv.y, uv.x, uv.y), vec3(margin));
    if (inside.x > margin && inside.y > margin && inside.z > margin) return point;
    inside = inside / (inside.x + inside.y + inside.z);
    return point_on_face(table, face, vec2(inside.y, inside.z));
}

// Returns a ray from a face, uniform by area and by the cosine of its angle with the normal. With two sides, half the
// rays leave each.
FUNC Ray diffuse_ray(FaceTable table, uint face, vec4 u, bool is_two_sided) {
    bool is_front = !is_two_sided || u.z < 0.5f;
    if (is_two_sided) u.z = is_front ? u.z * 2.0f : u.z * 2.0f - 1.0f;
    SurfacePoint point = inner_point(table, face, sample_triangle(vec2(u.x, u.y)));
    vec3 axis = is_front ? point.normal : -point.normal;
    Ray ray;
    ray.origin = spawn_position(point, is_front);
    ray.t_min = 0.0f;
    ray.direction = to_world(frame_about(axis), sample_cosine_hemisphere(vec2(u.z, u.w)));
    ray.t_max = uintBitsToFloat(0x7f800000u);
    return ray;
}

FUNC uint target_of(FaceTargetsArgs args, Ray ray, Hit hit) {
    if (hit.hit == 0u) return TARGET_OPEN;
    uint face = face_of(args.table, hit);
    if (args.is_two_sided == 0u && !meets_front(args.table, face, ray.direction)) return TARGET_BACK;
    return is_absent(args.groups) ? face : AT(args.groups, face);
}

// A convex polygon in barycentric coordinates u, v of the triangle, as two triangles: corners 0, 1, 2 and 0, 2, 3.
struct FacePart {
    vec2 corners[4];
    float first;  // the first triangle's share of the area: 1 where there is no other
};

// Returns a point uniform by area, for u uniform in the unit square: its barycentric coordinates.
FUNC vec2 sample_part(FacePart part, vec2 u) {
    bool is_first = u.x < part.first;
    float along = is_first ? u.x / part.first : (u.x - part.first) / (1.0f - part.first);
    vec2 at = sample_triangle(vec2(along, u.y));
    vec2 middle = is_first ? part.corners[1] : part.corners[2];
    vec2 last = is_first ? part.corners[2] : part.corners[3];
    return part.corners[0] + (middle - part.corners[0]) * at.x + (last - part.corners[0]) * at.y;
}
#endif
