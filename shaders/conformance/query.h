// SPDX-License-Identifier: MIT
// The questions of the conformance suite to a driver, and the answers; read by C++ and GLSL.
#ifndef TWINRAY_CONFORMANCE_QUERY_H
#define TWINRAY_CONFORMANCE_QUERY_H

// A ray with all that a ray query takes, and the treatment of its candidates.
struct Shot {
    Ray ray;
    uint flags;  // SPIR-V's ray flags
    uint cull_mask;
    uint refused;  // bit i: candidates of primitives i, i + 32, ... are refused
    float box_t;   // a box's primitive i is met at t = box_t + i * box_step
    float box_step;
    uint reserved;
};
BUFFER_OF(Shot, 8);

FUNC bool is_refused(Shot shot, uint primitive) { return ((shot.refused >> (primitive & 31u)) & 1u) != 0u; }
FUNC float box_t_of(Shot shot, uint primitive) { return shot.box_t + float(primitive) * shot.box_step; }

const uint ANSWER_MISS = 0u;
const uint ANSWER_TRIANGLE = 1u;
const uint ANSWER_BOX = 2u;

// A map.
struct Columns {
    vec3 c0;
    vec3 c1;
    vec3 c2;
    vec3 c3;
};

// The committed hit, and the number of candidates on the way. A miss has zeros but for the candidates.
struct Answer {
    uint kind;  // ANSWER_...
    float t;
    uint instance;
    uint custom_index;
    uint sbt_offset;
    uint geometry;
    uint primitive;
    uint is_front;
    vec2 uv;
    vec3 object_origin;
    vec3 object_direction;
    Columns to_world;
    uint triangles;  // candidates
    uint boxes;
    uint opaque_boxes;  // of `boxes`, those reported as opaque; OPACITY_UNKNOWN if no stage is told
    uint outside;       // triangles whose t was not inside the interval that was left
};
BUFFER_OF(Answer, 4);
const uint OPACITY_UNKNOWN = 0xffffffffu;

// Returns one word that names a candidate. Instances are below 2048, geometries below 256, primitives below 4096.
FUNC uint candidate_name(bool is_box, uint instance, uint geometry, uint primitive) {
    return (is_box ? 0x80000000u : 0u) | (instance << 20u) | (geometry << 12u) | primitive;
}

struct QueryArgs {
    Address structure;  // a top level
    REF(Shot) shots;
    REF(Answer) answers;  // written
    Uints candidates;  // written: `slots` words for each shot, those of its first candidates; absent where slots is 0
    uint count;
    uint slots;
};
BUFFER_OF(QueryArgs, 4);
#endif
