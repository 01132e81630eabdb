// SPDX-License-Identifier: MIT
// Converts a caller's mesh in device memory to 3 floats per vertex and 3 indices per triangle.
#ifndef TWINRAY_SHARED_GATHER_MESH_H
#define TWINRAY_SHARED_GATHER_MESH_H
#include "twinray/glsl/half.h"

// The values of VertexFormat and IndexFormat.
const uint VERTEX_FLOAT32 = 0u;
const uint VERTEX_FLOAT16 = 1u;
const uint INDEX_NONE = 0u;
const uint INDEX_UINT16 = 1u;

struct GatherMeshArgs {
    Address positions;
    Address indices;
    Uints count_on_device;  // absent: triangle_count
    Floats to_positions;
    Uints to_indices;
    Uints faulty;  // counts triangles with an index out of range
    uint vertex_count;
    uint triangle_count;
    uint stride;
    uint vertex_format;
    uint index_format;
    float factor;  // of positions
};

// Returns bits / 32767 as a signed number, at least -1, rounded once: 1 / 32767 is 2^-15 + 2^-30 + 2^-45 and less.
FUNC float float_of_snorm16(uint bits) {
    float value = float(int(bits << 16u) >> 16);
    PRECISE float rest = value * 9.31322574615478515625e-10f;
    PRECISE float further = value * 2.8421709430404007e-14f;
    rest = rest + further;
    PRECISE float whole = value * 0.000030517578125f;
    whole = whole + rest;
    return whole < -1.0f ? -1.0f : whole;
}
#endif
