// SPDX-License-Identifier: MIT
// The common part of the renderer's shaders: the scene by address, and the surface that a pixel sees.
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_buffer_reference_uvec2 : require

struct Vertex {
    vec3 position;
    vec3 normal;
};

struct Body {
    vec4 to_world[3];  // rows
    vec3 color;
    uint reserved;
    uvec2 vertices, indices;  // addresses
};

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer VertexList { Vertex items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer IndexList { uvec3 items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer BodyList { Body items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer IdList { uvec2 items[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer ColorList { uint items[]; };

layout(push_constant, scalar) uniform Push {
    uvec2 bodies, ids, rays, hits, colors;  // addresses
    vec3 eye, forward, right, up;           // right and up reach to the edges of the picture
    uint width, height;
    uint rays_per_pixel;  // 0: nothing is traced
    uint reserved;
}
args;

const uint NO_BODY = 0xffffffffu;
const vec3 TO_SUN = normalize(vec3(-0.8, 1.0, 0.35));

vec3 transformed(Body body, vec4 v) {
    return vec3(dot(body.to_world[0], v), dot(body.to_world[1], v), dot(body.to_world[2], v));
}

vec3 view_direction(uvec2 pixel) {
    vec2 at = (vec2(pixel) + 0.5) / vec2(args.width, args.height);
    return args.forward + args.right * (2.0 * at.x - 1.0) + args.up * (1.0 - 2.0 * at.y);
}

// The surface that a pixel sees.
struct Seen {
    Body body;
    Vertex a, b, c;  // of the triangle
    vec2 uv;         // where in it: at (1-u-v) a + u b + v c
    vec3 normal;     // of the surface there, in the world
};

bool look(uvec2 pixel, out Seen seen) {
    uvec2 id = IdList(args.ids).items[pixel.y * args.width + pixel.x];
    if (id.x == NO_BODY) return false;
    seen.body = BodyList(args.bodies).items[id.x];
    uvec3 corners = IndexList(seen.body.indices).items[id.y];
    seen.a = VertexList(seen.body.vertices).items[corners.x];
    seen.b = VertexList(seen.body.vertices).items[corners.y];
    seen.c = VertexList(seen.body.vertices).items[corners.z];
    // The point at which the line of sight meets the triangle's plane, moved into the triangle.
    vec3 a = transformed(seen.body, vec4(seen.a.position, 1.0));
    vec3 edge1 = transformed(seen.body, vec4(seen.b.position - seen.a.position, 0.0));
    vec3 edge2 = transformed(seen.body, vec4(seen.c.position - seen.a.position, 0.0));
    vec3 direction = view_direction(pixel);
    vec3 p = cross(direction, edge2);
    float determinant = dot(edge1, p);
    float u = clamp(dot(args.eye - a, p) / determinant, 0.0, 1.0);
    float v = clamp(dot(direction, cross(args.eye - a, edge1)) / determinant, 0.0, 1.0 - u);
    seen.uv = determinant == 0.0 ? vec2(0.0) : vec2(u, v);
    vec3 normal = seen.a.normal * (1.0 - seen.uv.x - seen.uv.y) + seen.b.normal * seen.uv.x + seen.c.normal * seen.uv.y;
    seen.normal = normalize(transformed(seen.body, vec4(normal, 0.0)));  // things are turned and scaled along axes
    return true;
}
