// SPDX-License-Identifier: MIT
// Access to a structure of arrays in kernels: its view() is a struct declared by TWINRAY_SOA_VIEW.
//
//     vec3 direction = vec3(0); // the result for an index out of range
//     SOA_GET(push.queue, i, direction, direction)
//     SOA_SET(push.queue, i, t_max, 2.0 * t_max)
//
// An index that is not below `count` reads and writes nothing. Kernels compiled with TWINRAY_DEBUG record it, for
// Soa::check_faults(). If i is known to be in range, AT(push.queue.direction, i) is the same without the comparison.
#ifndef TWINRAY_SOA_GLSL
#define TWINRAY_SOA_GLSL
#include "twinray/glsl/faults.glsl"
#include "twinray/glsl/soa.h"

// A statement: variable = field of item i, if there is one. `queue` is a variable or a member, not a call.
#define SOA_GET(queue, i, field, variable)     \
    {                                          \
        if ((i) < queue.count) {               \
            variable = AT(queue.field, i);     \
        } else {                               \
            TWINRAY_FAULT(queue.faults, 0u, i) \
        }                                      \
    }
// A statement: field of item i = value, if there is one.
#define SOA_SET(queue, i, field, value)        \
    {                                          \
        if ((i) < queue.count) {               \
            AT(queue.field, i) = value;        \
        } else {                               \
            TWINRAY_FAULT(queue.faults, 0u, i) \
        }                                      \
    }
#endif
