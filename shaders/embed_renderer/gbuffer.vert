// SPDX-License-Identifier: MIT
// Three vertices for each triangle, fetched by address: so gl_VertexIndex tells the triangle, which the rays need.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/embed_renderer/includes.glsl"
layout(push_constant, scalar) uniform Push { RasterArgs args; };
layout(location = 0) out vec3 normal;
layout(location = 1) out vec4 uv; // both sets
layout(location = 2) flat out uvec2 ids;
layout(location = 3) out vec3 color;

// Depth is near / z: 1 at the near plane, 0 at infinity.
vec4 projected(vec3 position)
{
    CameraRays camera = AT(args.frame, 0).camera;
    vec3 from_eye = position - camera.origin;
    float z = dot(from_eye, camera.forward);
    float x = dot(from_eye, camera.right) / dot(camera.right, camera.right);
    float y = dot(from_eye, camera.up) / dot(camera.up, camera.up);
    return vec4(x, -y, AT(args.frame, 0).near, z);
}

void main()
{
    uint primitive = uint(gl_VertexIndex) / 3u;
    SurfaceInstance instance = AT(AT(args.frame, 0).instances, gl_InstanceIndex);
    uvec3 corners = AT(instance.triangles, primitive).vertices;
    uint index = corners[uint(gl_VertexIndex) % 3u];
    SurfaceVertex vertex = AT(instance.vertices, index);
    vec3 object_normal = vertex.normal;
    if (object_normal == vec3(0.0))
    {
        vec3 a = AT(instance.vertices, corners.x).position;
        object_normal = cross(AT(instance.vertices, corners.y).position - a,
                              AT(instance.vertices, corners.z).position - a);
    }
    gl_Position = projected(transform_point(instance.object_to_world, vertex.position));
    normal = normalize(transposed_times(instance.world_to_object, object_normal));
    uv = vec4(vertex.uv, vertex.uv);
    color = vec3(1.0);
    if (!is_absent(AT(args.frame, 0).extras))
    {
        VertexExtras extras = AT(AT(args.frame, 0).extras, gl_InstanceIndex);
        uv.zw = second_uv_of(extras, index, vertex.uv);
        color = color_of(extras, index).rgb;
    }
    ids = uvec2(gl_InstanceIndex, primitive);
}
