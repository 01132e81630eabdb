// SPDX-License-Identifier: MIT
// Bilinear sampling of 8-bit textures that lie in plain buffers.
#ifndef TWINRAY_PATH_TRACER_TEXTURE_GLSL
#define TWINRAY_PATH_TRACER_TEXTURE_GLSL

// To [0, 1] within one period.
float wrapped(float x, uint mode)
{
    if (mode == WRAP_CLAMP) return clamp(x, 0.0, 1.0);
    if (mode == WRAP_MIRROR) return 1.0 - abs(x - 2.0 * floor(0.5 * x) - 1.0);
    return x - floor(x);
}

// The neighbour of a texel just outside; never out of range, whatever a NaN became.
uint neighbour(int i, uint size, uint mode)
{
    if (mode == WRAP_REPEAT) i = i < 0 ? int(size) - 1 : (i >= int(size) ? 0 : i);
    return min(uint(max(i, 0)), size - 1u);
}

vec3 srgb_to_linear(vec3 c)
{
    return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

vec4 texel(TexelGrid image, uint x, uint y, bool is_srgb)
{
    vec4 color = unpackUnorm4x8(AT(image.texels, y * image.width + x));
    return is_srgb ? vec4(srgb_to_linear(color.rgb), color.a) : color;
}

vec2 transformed_uv(TextureSlot slot, vec2 uv)
{
    return vec2(dot(slot.row0, vec3(uv, 1.0)), dot(slot.row1, vec3(uv, 1.0)));
}

// Filters after decoding, as GPUs do.
vec4 sample_texture(REF(TexelGrid) images, TextureSlot slot, vec2 uv, bool is_srgb)
{
    TexelGrid image = AT(images, slot.image);
    uint mode_u = slot.wrap & 0xffu;
    uint mode_v = slot.wrap >> 8u;
    vec2 moved = transformed_uv(slot, uv);
    vec2 at = vec2(wrapped(moved.x, mode_u) * float(image.width), wrapped(moved.y, mode_v) * float(image.height)) - 0.5;
    vec2 low = floor(at);
    vec2 weight = at - low;
    uint x0 = neighbour(int(low.x), image.width, mode_u);
    uint x1 = neighbour(int(low.x) + 1, image.width, mode_u);
    uint y0 = neighbour(int(low.y), image.height, mode_v);
    uint y1 = neighbour(int(low.y) + 1, image.height, mode_v);
    vec4 top = mix(texel(image, x0, y0, is_srgb), texel(image, x1, y0, is_srgb), weight.x);
    vec4 bottom = mix(texel(image, x0, y1, is_srgb), texel(image, x1, y1, is_srgb), weight.x);
    return mix(top, bottom, weight.y);
}
#endif
