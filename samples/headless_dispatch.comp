// SPDX-License-Identifier: MIT
// Computes the sky view of each cell of a horizontal grid: the fraction of cosine-weighted rays that hit nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/query.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
    Address accel;
    Floats sky_view;  // a value per cell, written
    vec3 corner;      // of the grid, in world space; y is up
    float cell;       // width of a cell
    uint width;       // cells along x
    uint count;       // cells
    uint rays;        // per cell
}
push;

vec3 cosine_weighted(uint i)  // point i of the R2 sequence (Roberts 2018) on the disk, lifted to the hemisphere
{
    vec2 u = vec2(uvec2(i * 3242174889u, i * 2447445414u) >> 8u) / 16777216.0f;
    return vec3(sqrt(u.x) * cos(6.2831853f * u.y), sqrt(1.0f - u.x), sqrt(u.x) * sin(6.2831853f * u.y));
}

void main() {
    uint i = global_index();
    if (i >= push.count) return;
    vec3 origin = push.corner + push.cell * vec3(float(i % push.width) + 0.5f, 0.0f, float(i / push.width) + 0.5f);
    uint seen = 0u;
    for (uint k = 0u; k < push.rays; k++) {
        Ray ray = Ray(origin, 0.0f, cosine_weighted(i * push.rays + k), uintBitsToFloat(0x7f800000u));
        if (!any_hit(push.accel, ray)) seen++;
    }
    AT(push.sky_view, i) = float(seen) / float(push.rays);
}
