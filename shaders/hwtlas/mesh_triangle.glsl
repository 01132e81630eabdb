// SPDX-License-Identifier: MIT
// A triangle of a mesh whose vertices move, and its box.
#ifndef TWINRAY_HWTLAS_MESH_TRIANGLE_GLSL
#define TWINRAY_HWTLAS_MESH_TRIANGLE_GLSL

struct MeshTriangle
{
    vec3 v0;
    vec3 v1;
    vec3 v2;
    bool is_active;
};

MeshTriangle load_triangle(HwTrianglesArgs mesh, uint triangle)
{
    MeshTriangle t;
    uvec3 vertices = load_indices(mesh.indices, triangle);
    t.v0 = load_position(mesh.positions, vertices.x);
    t.v1 = load_position(mesh.positions, vertices.y);
    t.v2 = load_position(mesh.positions, vertices.z);
    t.is_active = is_active_triangle(t.v0, t.v1, t.v2);
    return t;
}

GeometryBox box_of(MeshTriangle t)
{
    GeometryBox box;
    box.lo = min(t.v0, min(t.v1, t.v2));
    box.hi = max(t.v0, max(t.v1, t.v2));
    return box;
}
#endif
