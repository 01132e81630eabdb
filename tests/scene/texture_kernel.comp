// Asks a store for sizes, texels, and colours with and without mipmaps.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "twinray/glsl/textures.glsl"
#include "tests/scene/texture_kernel.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { TextureTestArgs args; };

void main() {
    uint i = global_index();
    if (i >= args.count) return;
    TextureQuestion question = AT(args.questions, i);
    AT(args.answers, i).size = texture_size(args.textures, question.texture);
    AT(args.answers, i).texel = fetch_texel(args.textures, question.texture, ivec2(question.x, question.y));
    AT(args.answers, i).color = sample_texture(args.textures, question.texture, question.uv);
    AT(args.answers, i).lod_color = sample_texture_lod(args.textures, question.texture, question.uv, question.lod);
    AT(args.answers, i).levels = texture_levels(args.textures, question.texture);
}
