// SPDX-License-Identifier: MIT
// Access to the textures of a TextureStore in kernels, by TextureStore::view().
//
//     vec4 color = sample_texture(push.textures, material.base_color, uv);
//
// Compile it with TWINRAY_BINDLESS for stores whose textures are images (TextureStore::has_images()), and without for
// those whose textures are in buffers. With it set 0, binding 0 is the store's array of images.
//
// sample_texture() samples the whole image, sample_texture_lod() its mipmaps, which blur over 2^lod texels.
//
// A reference that names nothing, including TextureRef(0), is white, so that it changes no factor. Kernels compiled
// with TWINRAY_DEBUG record those that are not TextureRef(0), for TextureStore::check_faults().
#ifndef TWINRAY_TEXTURES_GLSL
#define TWINRAY_TEXTURES_GLSL
#ifdef TWINRAY_BINDLESS
#extension GL_EXT_nonuniform_qualifier : require
#endif
#include "twinray/glsl/faults.glsl"
#include "twinray/glsl/half.h"
#include "twinray/glsl/textures.h"
layout(constant_id = TEXEL_FORMATS_CONSTANT) const bool TEXEL_FORMATS = true;

// Returns whether the reference names a texture of the table.
bool has_texture(TextureTable table, TextureRef ref) {
    if (ref.number - 1u < table.count) return true;
    if (ref.number != 0u) {
        TWINRAY_FAULT(table.faults, 0u, ref.number - 1u)
    }
    return false;
}

#ifdef TWINRAY_BINDLESS
layout(set = 0, binding = 0) uniform sampler2D twinray_images[];
#define TWINRAY_IMAGE(ref) twinray_images[nonuniformEXT(ref.number - 1u)]

// Returns (0, 0) if the reference names no texture.
uvec2 texture_size(TextureTable table, TextureRef ref) {
    if (!has_texture(table, ref)) return uvec2(0u);
    return uvec2(textureSize(TWINRAY_IMAGE(ref), 0));
}

// Returns one texel, decoded; for (x, y) outside, that of the nearest edge.
vec4 fetch_texel(TextureTable table, TextureRef ref, ivec2 at) {
    if (!has_texture(table, ref)) return vec4(1.0);
    return texelFetch(TWINRAY_IMAGE(ref), clamp(at, ivec2(0), textureSize(TWINRAY_IMAGE(ref), 0) - 1), 0);
}

// Samples bilinearly, with the precision of the device's samplers, or takes the nearest texel, as the texture was
// pushed.
vec4 sample_texture(TextureTable table, TextureRef ref, vec2 uv) {
    if (!has_texture(table, ref)) return vec4(1.0);
    return textureLod(TWINRAY_IMAGE(ref), uv, 0.0);
}

// The same for a texture that was not pushed as sRGB: kernels that decode themselves then leave that code out.
vec4 sample_linear_texture(TextureTable table, TextureRef ref, vec2 uv) { return sample_texture(table, ref, uv); }

// Samples trilinearly, or from one level, as the texture was pushed; lod counts levels from 0, the whole image.
vec4 sample_texture_lod(TextureTable table, TextureRef ref, vec2 uv, float lod) {
    if (!has_texture(table, ref)) return vec4(1.0);
    return textureLod(TWINRAY_IMAGE(ref), uv, lod);
}

// Returns 0 if the reference names no texture.
uint texture_levels(TextureTable table, TextureRef ref) {
    if (!has_texture(table, ref)) return 0u;
    return uint(textureQueryLevels(TWINRAY_IMAGE(ref)));
}
#else
// Converts sRGB in [0, 1] to linear light.
vec3 texture_srgb_to_linear(vec3 c) {
    return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

// Maps x to [0, 1] within one period.
float texture_wrapped(float x, uint mode) {
    if (mode == TEXTURE_CLAMP) return clamp(x, 0.0, 1.0);
    if (mode == TEXTURE_MIRROR) return 1.0 - abs(x - 2.0 * floor(0.5 * x) - 1.0);
    return x - floor(x);
}

// Returns the neighbour of a texel just outside; never out of range, even from a NaN.
uint texture_neighbour(int i, uint size, uint mode) {
    if (mode == TEXTURE_REPEAT) i = i < 0 ? int(size) - 1 : (i >= int(size) ? 0 : i);
    return min(uint(max(i, 0)), size - 1u);
}

// Returns number `index` from the start of a level.
float texel_number(TextureRecord record, uint format, uint index) {
    if (format == TEXEL_FLOAT32) return uintBitsToFloat(AT(record.texels, index));
    if (format == TEXEL_UNORM8) return float((AT(record.texels, index >> 2u) >> (8u * (index & 3u))) & 255u) / 255.0;
    uint bits = (AT(record.texels, index >> 1u) >> (16u * (index & 1u))) & 0xffffu;
    return format == TEXEL_FLOAT16 ? float_of_half(bits) : float(bits) / 65535.0;
}

// Returns texel (x, y) of a level, both in range, decoded; fewer than four channels are completed by 0, 0, 1.
vec4 texture_texel(TextureRecord record, uint x, uint y, bool is_srgb) {
    uint texel = y * record.width + x, format = record.format & 3u, channels = record.format >> 2u;
    vec4 color = vec4(0.0, 0.0, 0.0, 1.0);
    if (!TEXEL_FORMATS || (format == TEXEL_UNORM8 && channels == 4u))
        color = unpackUnorm4x8(AT(record.texels, texel));
    else {
        uint first = texel * channels;
        color.r = texel_number(record, format, first);
        if (channels > 1u) color.g = texel_number(record, format, first + 1u);
        if (channels > 2u) color.b = texel_number(record, format, first + 2u);
        if (channels > 3u) color.a = texel_number(record, format, first + 3u);
    }
    return is_srgb ? vec4(texture_srgb_to_linear(color.rgb), color.a) : color;
}

// Returns a level as a texture of its own.
TextureRecord texture_level(TextureRecord record, uint level) {
    uint channels = record.format >> 2u, format = record.format & 3u;
    uint bytes = format == TEXEL_UNORM8 ? 1u : (format == TEXEL_FLOAT32 ? 4u : 2u);
    for (uint i = 0u; i < level; i = i + 1u) {
        uint level_bytes = (record.width * record.height * channels * bytes + 3u) & ~3u;
        record.texels = Uints(address_after(record.texels.address, level_bytes));
        record.width = max(record.width >> 1u, 1u);
        record.height = max(record.height >> 1u, 1u);
    }
    return record;
}

// Returns 0 if the reference names no texture.
uint texture_levels(TextureTable table, TextureRef ref) {
    if (!has_texture(table, ref)) return 0u;
    return AT(table.records, ref.number - 1u).levels;
}

// Returns (0, 0) if the reference names no texture.
uvec2 texture_size(TextureTable table, TextureRef ref) {
    if (!has_texture(table, ref)) return uvec2(0u);
    TextureRecord record = AT(table.records, ref.number - 1u);
    return uvec2(record.width, record.height);
}

// Returns one texel, decoded; for (x, y) outside, that of the nearest edge.
vec4 fetch_texel(TextureTable table, TextureRef ref, ivec2 at) {
    if (!has_texture(table, ref)) return vec4(1.0);
    TextureRecord record = AT(table.records, ref.number - 1u);
    ivec2 inside = clamp(at, ivec2(0), ivec2(record.width, record.height) - 1);
    return texture_texel(record, uint(inside.x), uint(inside.y), (record.options & 1u) != 0u);
}

// Samples bilinearly in float32, after decoding; takes the nearest texel by weights of 0 and 1.
vec4 texture_filtered(TextureRecord record, vec2 uv, bool is_srgb) {
    uint wrap_u = record.wraps & 3u, wrap_v = record.wraps >> 2u;
    vec2 at = vec2(texture_wrapped(uv.x, wrap_u) * float(record.width),
                   texture_wrapped(uv.y, wrap_v) * float(record.height)) -
              0.5;
    vec2 low = floor(at);
    vec2 weight = (record.options & 2u) != 0u ? step(0.5, at - low) : at - low;
    uint x0 = texture_neighbour(int(low.x), record.width, wrap_u);
    uint x1 = texture_neighbour(int(low.x) + 1, record.width, wrap_u);
    uint y0 = texture_neighbour(int(low.y), record.height, wrap_v);
    uint y1 = texture_neighbour(int(low.y) + 1, record.height, wrap_v);
    if (TEXEL_FORMATS) {
        vec4 sum = vec4(0.0);  // a loop, because the code that reads any format is long
        DONT_UNROLL for (uint corner = 0u; corner < 4u; corner = corner + 1u) {
            bool is_right = (corner & 1u) != 0u, is_lower = (corner & 2u) != 0u;
            float share = (is_right ? weight.x : 1.0 - weight.x) * (is_lower ? weight.y : 1.0 - weight.y);
            if (share != 0.0) sum += share * texture_texel(record, is_right ? x1 : x0, is_lower ? y1 : y0, is_srgb);
        }
        return sum;
    }
    vec4 top = mix(texture_texel(record, x0, y0, is_srgb), texture_texel(record, x1, y0, is_srgb), weight.x);
    vec4 bottom = mix(texture_texel(record, x0, y1, is_srgb), texture_texel(record, x1, y1, is_srgb), weight.x);
    return mix(top, bottom, weight.y);
}

// Samples bilinearly in float32, or takes the nearest texel, as the texture was pushed. v = 0 is the edge of the first
// row.
vec4 sample_texture(TextureTable table, TextureRef ref, vec2 uv) {
    if (!has_texture(table, ref)) return vec4(1.0);
    TextureRecord record = AT(table.records, ref.number - 1u);
    return texture_filtered(record, uv, (record.options & 1u) != 0u);
}

// The same for a texture that was not pushed as sRGB: kernels then leave the decoding out.
vec4 sample_linear_texture(TextureTable table, TextureRef ref, vec2 uv) {
    if (!has_texture(table, ref)) return vec4(1.0);
    return texture_filtered(AT(table.records, ref.number - 1u), uv, false);
}

// Samples trilinearly, or from one level, as the texture was pushed.
vec4 sample_texture_lod(TextureTable table, TextureRef ref, vec2 uv, float lod) {
    if (!has_texture(table, ref)) return vec4(1.0);
    TextureRecord record = AT(table.records, ref.number - 1u);
    bool is_srgb = (record.options & 1u) != 0u;
    lod = clamp(lod, 0.0, float(record.levels - 1u));
    if ((record.options & 4u) != 0u) lod = ceil(lod + 0.5) - 1.0;
    uint level = min(uint(lod), record.levels - 1u);  // in range even from a NaN
    TextureRecord large = texture_level(record, level);
    vec4 color = texture_filtered(large, uv, is_srgb);
    float share = lod - float(level);
    if (!(share > 0.0) || level + 1u == record.levels) return color;
    return mix(color, texture_filtered(texture_level(large, 1u), uv, is_srgb), share);
}
#endif
#endif
