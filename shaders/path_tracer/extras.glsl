// SPDX-License-Identifier: MIT
// What some vertices have beyond their records.
#ifndef TWINRAY_PATH_TRACER_EXTRAS_GLSL
#define TWINRAY_PATH_TRACER_EXTRAS_GLSL

// The first texture coordinates stand in where a mesh has no others.
vec2 second_uv_of(VertexExtras extras, uint vertex, vec2 first)
{
    return uint64_t(extras.second_uvs) == 0ul ? first : FLOATS(AT(extras.second_uvs, vertex));
}

vec4 color_of(VertexExtras extras, uint vertex)
{
    if (uint64_t(extras.colors) == 0ul) return vec4(1.0);
    return vec4(FLOATS(AT(extras.colors, 2u * vertex)), FLOATS(AT(extras.colors, 2u * vertex + 1u)));
}
#endif
