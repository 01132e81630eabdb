// SPDX-License-Identifier: MIT
// The targets: base colour, shading normal, and which triangle of which instance the pixel shows.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/embed_renderer/includes.glsl"
layout(push_constant, scalar) uniform Push { RasterArgs args; };
layout(location = 0) in vec3 normal;
layout(location = 1) in vec4 uv; // both sets
layout(location = 2) flat in uvec2 ids;
layout(location = 3) in vec3 vertex_color;
layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uvec2 out_ids;

void main()
{
    uint index = AT(AT(AT(args.frame, 0).instances, ids.x).triangles, ids.y).material;
    SurfaceMaterial material = AT(AT(args.frame, 0).materials, index);
    vec3 color = material.base_color.rgb * vertex_color;
    if ((material.flags & MATERIAL_BASE_TEXTURE) != 0u)
        color *= sample_texture(AT(args.frame, 0).textures, material.base_texture.texture,
                                transformed_uv(material.base_texture,
                                               material.base_texture.uv_set != 0u ? uv.zw : uv.xy)).rgb;
    out_albedo = vec4(color, 1.0);
    out_normal = vec4(normalize(normal), 0.0);
    out_ids = ids;
}
