// SPDX-License-Identifier: MIT
// Light from the sun where its rays arrive, light from the sky where nothing is near.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/embed_renderer/pixels.glsl"
layout(push_constant, scalar) uniform Push { CompositeArgs args; };

// The share of a pixel's rays that met nothing.
float passed(REF(Hit) hits, uint first, uint count)
{
    uint met = 0u;
    for (uint i = 0u; i < count; ++i) met += AT(hits, first + i).hit;
    return 1.0 - float(met) / float(count);
}

vec3 background(vec3 sky, vec3 view)
{
    float height = 0.5 + 0.5 * normalize(view).y;
    return sky * mix(vec3(1.1), vec3(0.6, 0.8, 1.2), height);
}

void main()
{
    FrameData frame = AT(args.frame, 0);
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width || pixel.y >= frame.height) return;
    uint index = pixel.y * frame.width + pixel.x;
    PixelRays slots = AT(args.pixels, index);
    vec3 view = view_direction(frame.camera, pixel, vec2(frame.width, frame.height));
    vec3 color = background(frame.sky, view);
    if (texelFetch(ids_target, ivec2(pixel), 0).x != BACKGROUND)
    {
        vec3 normal = normalize(texelFetch(normal_target, ivec2(pixel), 0).xyz);
        if (dot(normal, view) > 0.0) normal = -normal;
        // Without shadow rays everything that faces the sun is lit.
        float sunlit = max(dot(normal, frame.sun_direction), 0.0);
        if (slots.shadow != NO_SLOT) sunlit *= passed(args.shadow_hits, slots.shadow, frame.shadow_rays);
        else if (frame.shadow_rays > 0u) sunlit = 0.0;
        float open = slots.ao != NO_SLOT ? passed(args.ao_hits, slots.ao, frame.ao_rays) : 1.0;
        color = texelFetch(albedo_target, ivec2(pixel), 0).rgb * (frame.sun * sunlit + frame.sky * open);
    }
    AT(args.colors, index).rgb = color;
}
