// SPDX-License-Identifier: MIT
// Features that a scene or a trace may need and that traversal otherwise leaves out: one bit each of the specialisation
// constant FEATURES, which features_of() of engine/accel/trace_desc.h chooses. A kernel specialised for more is also
// right and gives the same hits, bit for bit; at LEVEL_FAST but for the signs of zeros.
#ifndef TWINRAY_SHARED_FEATURES_H
#define TWINRAY_SHARED_FEATURES_H

const uint FEATURE_BOXES = 1u;           // geometry of boxes, met by the intersection of a trace program
const uint FEATURE_FILTERS = 2u;         // instances whose hits a trace program may refuse
const uint FEATURE_REMAP = 4u;           // hardware: triangles and instances were reordered for the driver
const uint FEATURE_BVH2 = 8u;            // software: layout bvh2
const uint FEATURE_COMPRESSED = 16u;     // software: layout compressed4
const uint FEATURE_INSTANCES = 32u;      // software: not exactly one instance, so that there is a top level to traverse
const uint FEATURE_MASKS = 64u;          // software: an instance that the trace's mask may not see
const uint FEATURE_CULLING = 128u;       // software: the trace culls
const uint FEATURE_TRANSFORMS = 256u;    // software: an instance that is, or may be moved, elsewhere than its geometry
const uint FEATURE_HITS = 512u;          // the trace wants all of each hit, not only whether there is one
const uint FEATURE_COMPRESSED8 = 1024u;  // software: layout compressed8
const uint FEATURES_ALL = 2047u;

// How a ray is tested against triangles.
const uint LEVEL_FAST = 0u;        // Moeller-Trumbore: may lose rays at edges
const uint LEVEL_WATERTIGHT = 1u;  // exact signs of edges and of t: no leaks, a single hit at an edge
const uint LEVEL_REFINED = 2u;     // and float64 for t, u, v of the hit
const uint LEVEL_CERTIFIED = 3u;   // float64 decides which hit there is, and which is first

// Ids of the specialisation constants.
const uint QUERY_CONSTANT = 0u;       // QUERY_* of a batch kernel
const uint FEATURES_CONSTANT = 100u;  // of every kernel that includes twinray/glsl/query.glsl
const uint LEVEL_CONSTANT = 101u;
const uint INTERLEAVE_CONSTANT = 102u;  // of a batch kernel: see interleaved_group
const uint RAY_GROUP_CONSTANT = 103u;   // of a batch kernel: invocations of a group
const uint STACK_CONSTANT = 104u;       // of every kernel that includes twinray/glsl/query.glsl: STACK_*

// The memory of a software traversal's stack.
const uint STACK_SHARED = 0u;     // in the workgroup's memory
const uint STACK_REGISTERS = 1u;  // in registers that are found by comparison: where groups have no memory of their own
// The numbers of entries that it keeps: powers of two.
const uint STACK_SIZE = 16u;
const uint REGISTER_STACK_SIZE = 8u;  // small, because each is compared with the slot
#endif
