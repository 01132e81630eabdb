// SPDX-License-Identifier: MIT
// The two functions by which a trace program takes part in a traversal. One GLSL text serves the software traversal,
// ray queries and ray tracing pipelines. They may be called in any order, more than once, and for hits that do not
// count in the end, so they must depend on their arguments alone and write nothing.
#ifndef TWINRAY_PROGRAM_H
#define TWINRAY_PROGRAM_H
#include "twinray/glsl/rays.h"

// What a traversal has found and asks about.
struct Candidate {
    uint primitive_index;  // box or triangle of the geometry, in the user's numbering
    uint instance_index;
    uint custom_index;
    bool is_front;      // of a triangle, as culling has it: its front is met
    Address user_data;  // TraceDesc::user_data, or what a kernel gave closest_hit or any_hit; is_absent() where it gave
                        // none
};

#ifdef TWINRAY_PROGRAM
// Whether the ray, given in object space, meets what the box stands for, and where: t, in units of the ray's direction
// as is that of the whole trace, and two values of its own that Hit returns as u and v. A t that is not within
// (t_min, t_max) does not count. A point outside the box may or may not be found.
FUNC bool intersect_primitive(Candidate candidate, Ray ray_local, INOUT(float) t, INOUT(vec2) uv);

// Whether a hit of an instance that is non-opaque counts (alpha test): its t and u, v.
FUNC bool accept_hit(Candidate candidate, float t, vec2 uv);
#else
FUNC bool intersect_primitive(Candidate, Ray, INOUT(float), INOUT(vec2)) { return false; }
FUNC bool accept_hit(Candidate, float, vec2) { return true; }
#endif
#endif
