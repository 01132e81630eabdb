// SPDX-License-Identifier: MIT
// Kernels over pixels: the targets of the rasteriser, and which pixel an invocation is.
#ifndef TWINRAY_EMBED_RENDERER_PIXELS_GLSL
#define TWINRAY_EMBED_RENDERER_PIXELS_GLSL
#extension GL_EXT_samplerless_texture_functions : require
#include "shaders/embed_renderer/includes.glsl"
layout(local_size_x = TILE, local_size_y = TILE) in;
layout(set = 0, binding = 0) uniform texture2D albedo_target;
layout(set = 0, binding = 1) uniform texture2D normal_target;
layout(set = 0, binding = 2) uniform utexture2D ids_target;

// Through the centre of the pixel, as the rasteriser samples.
vec3 view_direction(CameraRays camera, uvec2 pixel, vec2 size)
{
    vec2 at = (vec2(pixel) + 0.5) / size;
    return camera.forward + camera.right * (2.0 * at.x - 1.0) + camera.up * (1.0 - 2.0 * at.y);
}
#endif
