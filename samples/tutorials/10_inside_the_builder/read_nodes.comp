// SPDX-License-Identifier: MIT
// Copies the engine's tree out of its memory: the nodes of a scene of one mesh and one instance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/common.glsl"
#include "shaders/shared/bvh.h"
layout(local_size_x = 64) in;
// [kernel]
layout(push_constant, scalar) uniform Push {
    Address accel;
    REF(BvhNode) nodes;             // of layout bvh2, or absent
    REF(CompressedRecord) records;  // of layout compressed4, or absent
    Uints primitives;               // with the nodes: by position in the order
    uint count;
}
push;

void main() {
    uint i = global_index();
    if (i >= push.count) return;
    SwTlasHeader header = AT(REF(SwTlasHeader)(push.accel), 0);
    SwInstance instance = load_instance(header.instances, 0u);
    if (!is_absent(push.records)) {
        AT(push.records, i) = AT(instance.records, i);
        return;
    }
    AT(push.primitives, i) = load_triangle(instance.triangles, i).primitive_index;
    if (i + 1u < push.count) AT(push.nodes, i) = load_node(instance.nodes, i);
}
