// SPDX-License-Identifier: MIT
// The surface that a ray hit, computed only from the ids of the hit and the ray: an accelerator's own t, u and v are
// rounded in its own way and never used, so that the same ids give the same picture, bit for bit.
#ifndef TWINRAY_PATH_TRACER_SURFACE_GLSL
#define TWINRAY_PATH_TRACER_SURFACE_GLSL

// The first texture coordinates replace others that a mesh lacks.
vec2 second_uv_of(VertexExtras extras, uint vertex, vec2 first)
{
    return is_absent(extras.second_uvs) ? first : AT(extras.second_uvs, vertex);
}

vec4 color_of(VertexExtras extras, uint vertex)
{
    if (is_absent(extras.colors)) return vec4(1.0);
    return AT(extras.colors, vertex);
}

struct TextureCoordinates
{
    vec2 first;
    vec2 second; // the first where a mesh has no others
};

struct Surface
{
    SurfacePoint point;
    Placement placement;
    float t;            // along the ray that met it
    vec3 normal;        // shading normal, unit, on the side of point.normal
    vec3 tangent;       // world, for normal maps; not normalised
    vec3 bitangent;
    TextureCoordinates uv;
    vec4 color;         // of the vertices, linear
    uint material;
};

struct TriangleData
{
    SurfaceVertex vertex[3];
    vec2 second_uv[3];
    vec4 color[3];
    uint material;
};

void load_extras(inout TriangleData data, SceneData scene, uint instance, uvec3 vertices)
{
    if (!HAS_COLORS && !HAS_SECOND_UVS) return;
    VertexExtras extras = AT(scene.extras, instance);
    UNROLL for (uint i = 0u; i < 3u; i++)
    {
        if (HAS_SECOND_UVS) data.second_uv[i] = second_uv_of(extras, vertices[i], data.vertex[i].uv);
        if (HAS_COLORS) data.color[i] = color_of(extras, vertices[i]);
    }
}

TriangleData load_triangle_data(SceneData scene, uint instance_index, uint primitive)
{
    SurfaceInstance instance = AT(scene.instances, instance_index);
    SurfaceTriangle triangle = AT(instance.triangles, primitive);
    TriangleData data;
    data.vertex[0] = AT(instance.vertices, triangle.vertices.x);
    data.vertex[1] = AT(instance.vertices, triangle.vertices.y);
    data.vertex[2] = AT(instance.vertices, triangle.vertices.z);
    data.material = triangle.material;
    load_extras(data, scene, instance_index, triangle.vertices);
    return data;
}

Placement load_placement(REF(SurfaceInstance) instances, uint index)
{
    Placement placement;
    placement.to_world = AT(instances, index).object_to_world;
    placement.to_object = AT(instances, index).world_to_object;
    return placement;
}

TriangleVertices vertices_of(TriangleData data)
{
    TriangleVertices vertices;
    vertices.a = data.vertex[0].position;
    vertices.b = data.vertex[1].position;
    vertices.c = data.vertex[2].position;
    return vertices;
}

vec3 weights_of(vec2 at) { return vec3(1.0 - at.x - at.y, at); }

bool has_normal(SurfaceVertex vertex) { return vertex.normal != vec3(0.0); }

vec3 vertex_normal(SurfaceVertex vertex, vec3 of_triangle) { return has_normal(vertex) ? vertex.normal : of_triangle; }

vec3 vertex_normal(TriangleData data, SurfacePoint point, vec2 at)
{
    vec3 weights = weights_of(at);
    return vertex_normal(data.vertex[0], point.normal_object) * weights.x +
           vertex_normal(data.vertex[1], point.normal_object) * weights.y +
           vertex_normal(data.vertex[2], point.normal_object) * weights.z;
}

TextureCoordinates interpolated_uv(TriangleData data, vec2 at)
{
    vec3 weights = weights_of(at);
    TextureCoordinates uv;
    uv.first = data.vertex[0].uv * weights.x + data.vertex[1].uv * weights.y + data.vertex[2].uv * weights.z;
    uv.second = uv.first;
    if (HAS_SECOND_UVS)
        uv.second = data.second_uv[0] * weights.x + data.second_uv[1] * weights.y + data.second_uv[2] * weights.z;
    return uv;
}

vec4 interpolated_color(TriangleData data, vec2 at)
{
    if (!HAS_COLORS) return vec4(1.0);
    vec3 weights = weights_of(at);
    return data.color[0] * weights.x + data.color[1] * weights.y + data.color[2] * weights.z;
}

vec3 interpolated_normal(TriangleData data, SurfacePoint point, Placement placement, vec2 at)
{
    if (!has_normal(data.vertex[0]) && !has_normal(data.vertex[1]) && !has_normal(data.vertex[2])) return point.normal;
    vec3 normal = vertex_normal(data, point, at);
    if (dot(normal, normal) == 0.0) return point.normal;
    normal = normalize(transposed_times(placement.to_object, normal));
    // Files with vertex normals against their winding exist; the winding decides which side is the front.
    return dot(normal, point.normal) < 0.0 ? -normal : normal;
}

// Uses the file's tangents if there are any, else the derivatives of uv. glTF's bitangent points to smaller v (up in
// the picture).
void set_tangents(inout Surface surface, TriangleData data, uint flags, vec2 at)
{
    vec3 weights = weights_of(at);
    vec4 along = data.vertex[0].tangent * weights.x + data.vertex[1].tangent * weights.y +
                 data.vertex[2].tangent * weights.z;
    vec3 tangent = along.xyz;
    vec3 bitangent = cross(vertex_normal(data, surface.point, at), tangent) * (along.w < 0.0 ? -1.0 : 1.0);
    if (dot(bitangent, bitangent) > 0.0)
    {
        surface.tangent = transform_vector(surface.placement.to_world, tangent);
        surface.bitangent = transform_vector(surface.placement.to_world, bitangent);
        return;
    }
    vec2 uv0 = data.vertex[0].uv, uv1 = data.vertex[1].uv, uv2 = data.vertex[2].uv;
    if (HAS_SECOND_UVS && (flags & MATERIAL_SECOND_TANGENTS) != 0u)
        uv0 = data.second_uv[0], uv1 = data.second_uv[1], uv2 = data.second_uv[2];
    vec2 du = uv1 - uv0;
    vec2 dv = uv2 - uv0;
    vec3 edge1 = data.vertex[1].position - data.vertex[0].position;
    vec3 edge2 = data.vertex[2].position - data.vertex[0].position;
    float handedness = du.x * dv.y - du.y * dv.x < 0.0 ? -1.0 : 1.0;
    surface.tangent = transform_vector(surface.placement.to_world, (edge1 * dv.y - edge2 * du.y) * handedness);
    surface.bitangent = transform_vector(surface.placement.to_world, (edge1 * dv.x - edge2 * du.x) * handedness);
}

Surface surface_at(TriangleData data, Placement placement, vec2 at)
{
    Surface surface;
    surface.placement = placement;
    surface.point = surface_point(placement, vertices_of(data), at);
    surface.uv = interpolated_uv(data, at);
    surface.color = interpolated_color(data, at);
    surface.material = data.material;
    surface.normal = interpolated_normal(data, surface.point, placement, at);
    return surface;
}

Surface surface_of(SceneData scene, Ray ray, Hit hit)
{
    Placement placement = load_placement(scene.instances, hit.instance_index);
    TriangleData data = load_triangle_data(scene, hit.instance_index, hit.primitive_index);
    Crossing crossing = crossing_of(ray, placement, vertices_of(data));
    Surface surface = surface_at(data, placement, crossing.uv);
    surface.material = material_of(hit.custom_index, data.material);
    surface.t = crossing.t;
    if (HAS_TEXTURES || (LAYERS & LAYER_ANISOTROPY) != 0u)
        set_tangents(surface, data, AT(scene.materials, surface.material).flags, crossing.uv);
    return surface;
}

// The ray continues behind a surface that it hit. Its t_min grows with each, so that every ray gets through.
Ray behind(Ray ray, Surface surface)
{
    ray.t_min = passing_t(surface.point, surface.placement, ray, max(surface.t, ray.t_min));
    return ray;
}
#endif
