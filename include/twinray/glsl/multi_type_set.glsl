// SPDX-License-Identifier: MIT
// Access to the elements of a MultiTypeSet in kernels: its view() is a struct declared by TWINRAY_SET_VIEW.
//
//     vec3 color_of(Diffuse diffuse, vec2 uv) { ... }
//     vec3 color_of(Glass glass, vec2 uv) { ... }
//     #define COLOR_OF(element) color = color_of(element, uv)
//
//     vec3 color = vec3(1, 0, 1); // the result for a key that names nothing
//     WITH_INDEX(MATERIALS, push.materials, key, COLOR_OF)
//
// A key that names nothing calls nothing. Kernels compiled with TWINRAY_DEBUG note it, for
// MultiTypeSet::check_faults().
#ifndef TWINRAY_MULTI_TYPE_SET_GLSL
#define TWINRAY_MULTI_TYPE_SET_GLSL
#include "twinray/glsl/faults.glsl"
#include "twinray/glsl/multi_type_set.h"

// The arguments that lists pass on to each type.
#define SET_OF_(set, key, ACTION) set
#define KEY_OF_(set, key, ACTION) key
#define ACTION_OF_(set, key, ACTION) ACTION

#define SET_CASE_(P, number, Type, name)                                     \
    case uint(number) + 1u:                                                  \
        if (KEY_OF_ P.index < SET_OF_ P.name##_count) {                      \
            ACTION_OF_ P(AT(SET_OF_ P.name, KEY_OF_ P.index));               \
        } else {                                                             \
            TWINRAY_FAULT(SET_OF_ P.faults, KEY_OF_ P.type, KEY_OF_ P.index) \
        }                                                                    \
        break;
// Runs ACTION(element) for the element that `key` names: a switch over the types of the list. `set` and `key` are
// variables or members, not calls.
#define WITH_INDEX(LIST, set, key, ACTION)                             \
    switch (key.type) {                                                \
        LIST(SET_CASE_, (set, key, ACTION))                            \
        default: TWINRAY_FAULT(set.faults, key.type, key.index) break; \
    }

#define SET_LOOP_(P, number, Type, name)                                                  \
    for (uint name##_index = 0u; name##_index < SET_OF_ P.name##_count; name##_index++) { \
        ACTION_OF_ P(AT(SET_OF_ P.name, name##_index), set_index_);                       \
        set_index_++;                                                                     \
    }
// Runs ACTION(element, i) for all elements, type after type in the order of the list; i counts them from 0.
#define FOREACH_ELEMENT(LIST, set, ACTION) \
    {                                      \
        uint set_index_ = 0u;              \
        LIST(SET_LOOP_, (set, 0, ACTION))  \
    }
#endif
