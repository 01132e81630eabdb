// SPDX-License-Identifier: MIT
// The two functions by which a trace program takes part in a traversal. One GLSL text serves the software traversal,
// ray queries and ray tracing pipelines. They may be called in any order, more than once, and for hits that are dropped
// in the end, so they must depend only on their arguments and write nothing.
#ifndef TWINRAY_PROGRAM_H
#define TWINRAY_PROGRAM_H
#include "twinray/glsl/rays.h"

// The object that the traversal has found and asks about.
struct Candidate {
    uint primitive_index;  // box or triangle of the geometry, in the user's numbering
    uint instance_index;
    uint custom_index;
    bool is_front;      // for triangles, by the rules of culling: its front is hit
    Address user_data;  // TraceDesc::user_data, or the argument of closest_hit or any_hit in a kernel; is_absent()
                        // without one
};

#ifdef TWINRAY_PROGRAM
// Returns whether the ray, given in object space, hits the object in the box. Sets t, in units of the ray's direction
// as in the whole trace, and two values of its own that Hit returns as u and v. A t outside (t_min, t_max) is ignored.
// A point outside the box may or may not be found.
FUNC bool intersect_primitive(Candidate candidate, Ray ray_local, INOUT(float) t, INOUT(vec2) uv);

// Returns whether a hit of a non-opaque instance counts (alpha test): its t and u, v.
FUNC bool accept_hit(Candidate candidate, float t, vec2 uv);
#else
FUNC bool intersect_primitive(Candidate, Ray, INOUT(float), INOUT(vec2)) { return false; }
FUNC bool accept_hit(Candidate, float, vec2) { return true; }
#endif
#endif
