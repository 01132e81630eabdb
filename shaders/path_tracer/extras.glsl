// SPDX-License-Identifier: MIT
// The attributes of some vertices beyond their records.
#ifndef TWINRAY_PATH_TRACER_EXTRAS_GLSL
#define TWINRAY_PATH_TRACER_EXTRAS_GLSL

// The first texture coordinates replace others that a mesh lacks.
vec2 second_uv_of(VertexExtras extras, uint vertex, vec2 first)
{
    return is_absent(extras.second_uvs) ? first : AT(extras.second_uvs, vertex);
}

vec4 color_of(VertexExtras extras, uint vertex)
{
    if (is_absent(extras.colors)) return vec4(1.0);
    return AT(extras.colors, vertex);
}
#endif
