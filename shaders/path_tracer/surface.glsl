// SPDX-License-Identifier: MIT
// The surface that a ray hit, computed only from the ids of the hit and the ray: an accelerator's own t, u and v are
// rounded in its own way and never used, so that the same ids give the same picture, bit for bit.
#ifndef TWINRAY_PATH_TRACER_SURFACE_GLSL
#define TWINRAY_PATH_TRACER_SURFACE_GLSL

struct TextureCoordinates {
    vec2 first;
    vec2 second;  // the first where a mesh has no others
};

struct Surface {
    SurfacePoint point;
    Placement placement;
    float t;       // along the ray that met it
    vec3 normal;   // shading normal, unit, on the side of point.normal
    vec3 tangent;  // world, for normal maps; not normalised
    vec3 bitangent;
    TextureCoordinates uv;
    vec4 color;  // of the vertices, linear
    uint material;
};

// An attribute that the mesh lacks is 0; the colour is 1, and the first texture coordinates replace the second.
struct SurfaceVertex {
    vec3 position;
    vec3 normal;
    vec2 uv;
    vec4 tangent;
    vec2 second_uv;
    vec4 color;
};

struct TriangleData {
    SurfaceVertex vertex[3];
    uint material;
};

SurfaceVertex load_vertex(SurfaceMesh mesh, uint index) {
    SurfaceVertex vertex;
    vertex.position = load_position(mesh.packed.positions, index);
    vertex.normal = vec3(0.0);
    vertex.uv = vec2(0.0);
    vertex.tangent = vec4(0.0);
    vertex.color = vec4(1.0);
    if (!is_absent(mesh.normals)) vertex.normal = load_position(mesh.normals, index);
    if (!is_absent(mesh.uvs)) vertex.uv = AT(mesh.uvs, index);
    if (!is_absent(mesh.tangents)) vertex.tangent = AT(mesh.tangents, index);
    vertex.second_uv = vertex.uv;
    if (HAS_SECOND_UVS && !is_absent(mesh.second_uvs)) vertex.second_uv = AT(mesh.second_uvs, index);
    if (HAS_COLORS && !is_absent(mesh.colors)) vertex.color = AT(mesh.colors, index);
    return vertex;
}

uint material_of_triangle(SurfaceMesh mesh, uint primitive) {
    if (is_absent(mesh.materials)) return 0u;
    return AT(mesh.materials, primitive);
}

TriangleData load_triangle_data(SceneData scene, uint instance, uint primitive) {
    SurfaceMesh mesh = AT(AT(scene.instances, instance).mesh, 0);
    uvec3 indices = load_indices(mesh.packed.indices, primitive);
    TriangleData data;
    UNROLL for (uint i = 0u; i < 3u; i++) data.vertex[i] = load_vertex(mesh, indices[i]);
    data.material = material_of_triangle(mesh, primitive);
    return data;
}

Placement load_placement(REF(SurfaceInstance) instances, uint index) {
    Placement placement;
    placement.to_world = AT(instances, index).object_to_world;
    placement.to_object = AT(instances, index).world_to_object;
    return placement;
}

TriangleVertices vertices_of(TriangleData data) {
    TriangleVertices vertices;
    vertices.a = data.vertex[0].position;
    vertices.b = data.vertex[1].position;
    vertices.c = data.vertex[2].position;
    return vertices;
}

vec3 weights_of(vec2 at) { return vec3(1.0 - at.x - at.y, at); }

bool has_normal(SurfaceVertex vertex) { return vertex.normal != vec3(0.0); }

vec3 vertex_normal(SurfaceVertex vertex, vec3 of_triangle) { return has_normal(vertex) ? vertex.normal : of_triangle; }

vec3 vertex_normal(TriangleData data, SurfacePoint point, vec2 at) {
    vec3 weights = weights_of(at);
    return vertex_normal(data.vertex[0], point.normal_object) * weights.x +
           vertex_normal(data.vertex[1], point.normal_object) * weights.y +
           vertex_normal(data.vertex[2], point.normal_object) * weights.z;
}

TextureCoordinates interpolated_uv(TriangleData data, vec2 at) {
    vec3 weights = weights_of(at);
    TextureCoordinates uv;
    uv.first = data.vertex[0].uv * weights.x + data.vertex[1].uv * weights.y + data.vertex[2].uv * weights.z;
    uv.second = uv.first;
    if (HAS_SECOND_UVS)
        uv.second = data.vertex[0].second_uv * weights.x + data.vertex[1].second_uv * weights.y +
                    data.vertex[2].second_uv * weights.z;
    return uv;
}

vec4 interpolated_color(TriangleData data, vec2 at) {
    if (!HAS_COLORS) return vec4(1.0);
    vec3 weights = weights_of(at);
    return data.vertex[0].color * weights.x + data.vertex[1].color * weights.y + data.vertex[2].color * weights.z;
}

vec3 interpolated_normal(TriangleData data, SurfacePoint point, Placement placement, vec2 at) {
    if (!has_normal(data.vertex[0]) && !has_normal(data.vertex[1]) && !has_normal(data.vertex[2])) return point.normal;
    vec3 normal = vertex_normal(data, point, at);
    if (dot(normal, normal) == 0.0) return point.normal;
    normal = normalize(transposed_times(placement.to_object, normal));
    // Files with vertex normals against their winding exist; the winding decides which side is the front.
    return dot(normal, point.normal) < 0.0 ? -normal : normal;
}

// Uses the file's tangents if there are any, else the derivatives of uv. glTF's bitangent points to smaller v (up in
// the picture).
void set_tangents(inout Surface surface, TriangleData data, uint flags, vec2 at) {
    vec3 weights = weights_of(at);
    vec4 along =
        data.vertex[0].tangent * weights.x + data.vertex[1].tangent * weights.y + data.vertex[2].tangent * weights.z;
    vec3 tangent = along.xyz;
    vec3 bitangent = cross(vertex_normal(data, surface.point, at), tangent) * (along.w < 0.0 ? -1.0 : 1.0);
    if (dot(bitangent, bitangent) > 0.0) {
        surface.tangent = transform_vector(surface.placement.to_world, tangent);
        surface.bitangent = transform_vector(surface.placement.to_world, bitangent);
        return;
    }
    vec2 uv0 = data.vertex[0].uv, uv1 = data.vertex[1].uv, uv2 = data.vertex[2].uv;
    if (HAS_SECOND_UVS && (flags & MATERIAL_SECOND_TANGENTS) != 0u)
        uv0 = data.vertex[0].second_uv, uv1 = data.vertex[1].second_uv, uv2 = data.vertex[2].second_uv;
    vec2 du = uv1 - uv0;
    vec2 dv = uv2 - uv0;
    vec3 edge1 = data.vertex[1].position - data.vertex[0].position;
    vec3 edge2 = data.vertex[2].position - data.vertex[0].position;
    float handedness = du.x * dv.y - du.y * dv.x < 0.0 ? -1.0 : 1.0;
    surface.tangent = transform_vector(surface.placement.to_world, (edge1 * dv.y - edge2 * du.y) * handedness);
    surface.bitangent = transform_vector(surface.placement.to_world, (edge1 * dv.x - edge2 * du.x) * handedness);
}

Surface surface_at(TriangleData data, Placement placement, vec2 at) {
    Surface surface;
    surface.placement = placement;
    surface.point = surface_point(placement, vertices_of(data), at);
    surface.uv = interpolated_uv(data, at);
    surface.color = interpolated_color(data, at);
    surface.material = data.material;
    surface.normal = interpolated_normal(data, surface.point, placement, at);
    return surface;
}

Surface surface_of(SceneData scene, Ray ray, Hit hit) {
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
Ray behind(Ray ray, Surface surface) {
    ray.t_min = passing_t(surface.point, surface.placement, ray, max(surface.t, ray.t_min));
    return ray;
}
#endif
