// SPDX-License-Identifier: MIT
// A picture of swatches, each of the material that its key names.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/multi_type_set.glsl"
#include "twinray/glsl/textures.glsl"
#include "samples/materials.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SwatchArgs args; };

vec3 color_of(Checker checker, vec2 uv) {
    uvec2 cell = uvec2(uv * checker.cells);
    return (cell.x + cell.y & 1u) == 0u ? checker.even : checker.odd;
}

vec3 color_of(Painted painted, vec2 uv) {
    return painted.gain * sample_texture(args.textures, painted.texture, uv).rgb;
}

void main() {
    uint i = global_index();
    uint width = args.swatches * args.side;
    if (i >= width * args.side) return;
    uvec2 pixel = uvec2(i % width, i / width);
    vec2 uv = (vec2(pixel.x % args.side, pixel.y) + 0.5) / float(args.side);

    SetKey key = AT(args.keys, pixel.x / args.side);
    vec3 color = vec3(1.0, 0.0, 1.0);  // of a key that names nothing
#define COLOR_OF(material) color = color_of(material, uv)
    WITH_INDEX(MATERIALS, args.materials, key, COLOR_OF)
    AT(args.picture, i) = packUnorm4x8(vec4(color, 1.0));
}
