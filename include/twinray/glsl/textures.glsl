// SPDX-License-Identifier: MIT
// Textures of a TextureStore in kernels: what TextureStore::view() gives.
//
//     vec4 color = sample_texture(push.textures, material.base_color, uv);
//
// Compiled with TWINRAY_BINDLESS for stores whose textures are images (TextureStore::has_images()), and without for
// those whose textures lie in buffers. With it set 0, binding 0 is the store's array of images.
//
// A reference that names nothing, TextureRef(0) too, is white, so that it changes no factor. Kernels compiled with
// TWINRAY_DEBUG note those that are not TextureRef(0), for TextureStore::check_faults().
#ifndef TWINRAY_TEXTURES_GLSL
#define TWINRAY_TEXTURES_GLSL
#ifdef TWINRAY_BINDLESS
#extension GL_EXT_nonuniform_qualifier : require
#endif
#include "twinray/glsl/faults.glsl"
#include "twinray/glsl/textures.h"

bool has_texture(TextureTable table, TextureRef ref)
{
    if (ref.number - 1u < table.count) return true;
    if (ref.number != 0u) { TWINRAY_FAULT(table.faults, 0u, ref.number - 1u) }
    return false;
}

#ifdef TWINRAY_BINDLESS
layout(set = 0, binding = 0) uniform sampler2D twinray_images[];
#define TWINRAY_IMAGE(ref) twinray_images[nonuniformEXT(ref.number - 1u)]

// (0, 0) where there is none.
uvec2 texture_size(TextureTable table, TextureRef ref)
{
    if (!has_texture(table, ref)) return uvec2(0u);
    return uvec2(textureSize(TWINRAY_IMAGE(ref), 0));
}

// One texel, decoded; (x, y) outside are those of the nearest edge.
vec4 fetch_texel(TextureTable table, TextureRef ref, ivec2 at)
{
    if (!has_texture(table, ref)) return vec4(1.0);
    return texelFetch(TWINRAY_IMAGE(ref), clamp(at, ivec2(0), textureSize(TWINRAY_IMAGE(ref), 0) - 1), 0);
}

// Bilinear, with the precision of the device's samplers, or the nearest texel, as the texture was pushed.
vec4 sample_texture(TextureTable table, TextureRef ref, vec2 uv)
{
    if (!has_texture(table, ref)) return vec4(1.0);
    return textureLod(TWINRAY_IMAGE(ref), uv, 0.0);
}

// The same of a texture that was not pushed as sRGB: kernels then lack the decoding, where that is theirs to do.
vec4 sample_linear_texture(TextureTable table, TextureRef ref, vec2 uv) { return sample_texture(table, ref, uv); }
#else
vec3 texture_srgb_to_linear(vec3 c)
{
    return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

// To [0, 1] within one period.
float texture_wrapped(float x, uint mode)
{
    if (mode == TEXTURE_CLAMP) return clamp(x, 0.0, 1.0);
    if (mode == TEXTURE_MIRROR) return 1.0 - abs(x - 2.0 * floor(0.5 * x) - 1.0);
    return x - floor(x);
}

// The neighbour of a texel just outside; never out of range, whatever a NaN became.
uint texture_neighbour(int i, uint size, uint mode)
{
    if (mode == TEXTURE_REPEAT) i = i < 0 ? int(size) - 1 : (i >= int(size) ? 0 : i);
    return min(uint(max(i, 0)), size - 1u);
}

vec4 texture_texel(TextureRecord record, uint x, uint y, bool is_srgb)
{
    vec4 color = unpackUnorm4x8(AT(record.texels, y * record.width + x));
    return is_srgb ? vec4(texture_srgb_to_linear(color.rgb), color.a) : color;
}

// (0, 0) where there is none.
uvec2 texture_size(TextureTable table, TextureRef ref)
{
    if (!has_texture(table, ref)) return uvec2(0u);
    TextureRecord record = AT(table.records, ref.number - 1u);
    return uvec2(record.width, record.height);
}

// One texel, decoded; (x, y) outside are those of the nearest edge.
vec4 fetch_texel(TextureTable table, TextureRef ref, ivec2 at)
{
    if (!has_texture(table, ref)) return vec4(1.0);
    TextureRecord record = AT(table.records, ref.number - 1u);
    ivec2 inside = clamp(at, ivec2(0), ivec2(record.width, record.height) - 1);
    return texture_texel(record, uint(inside.x), uint(inside.y), record.is_srgb != 0u);
}

// Bilinear in float32, after decoding; the nearest texel by weights of 0 and 1.
vec4 texture_filtered(TextureRecord record, vec2 uv, bool is_srgb)
{
    vec2 at = vec2(texture_wrapped(uv.x, record.wrap_u) * float(record.width),
                   texture_wrapped(uv.y, record.wrap_v) * float(record.height)) - 0.5;
    vec2 low = floor(at);
    vec2 weight = record.is_nearest != 0u ? step(0.5, at - low) : at - low;
    uint x0 = texture_neighbour(int(low.x), record.width, record.wrap_u);
    uint x1 = texture_neighbour(int(low.x) + 1, record.width, record.wrap_u);
    uint y0 = texture_neighbour(int(low.y), record.height, record.wrap_v);
    uint y1 = texture_neighbour(int(low.y) + 1, record.height, record.wrap_v);
    vec4 top = mix(texture_texel(record, x0, y0, is_srgb), texture_texel(record, x1, y0, is_srgb), weight.x);
    vec4 bottom = mix(texture_texel(record, x0, y1, is_srgb), texture_texel(record, x1, y1, is_srgb), weight.x);
    return mix(top, bottom, weight.y);
}

vec4 sample_texture(TextureTable table, TextureRef ref, vec2 uv)
{
    if (!has_texture(table, ref)) return vec4(1.0);
    TextureRecord record = AT(table.records, ref.number - 1u);
    return texture_filtered(record, uv, record.is_srgb != 0u);
}

// The same of a texture that was not pushed as sRGB: kernels then lack the decoding.
vec4 sample_linear_texture(TextureTable table, TextureRef ref, vec2 uv)
{
    if (!has_texture(table, ref)) return vec4(1.0);
    return texture_filtered(AT(table.records, ref.number - 1u), uv, false);
}
#endif
#endif
