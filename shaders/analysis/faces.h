// SPDX-License-Identifier: MIT
// Faces are the units of analyses: a face is a triangle of an instance. Faces are numbered by instance, then by
// triangle. The including file declares Face: face.glsl, in C++ <twinray/analysis.h>.
#ifndef TWINRAY_ANALYSIS_FACES_H
#define TWINRAY_ANALYSIS_FACES_H
#include "twinray/glsl/spawn.h"

struct FacesOfInstance {
    InstancedMesh placed;
    uint first;  // face of triangle 0
    uint reserved;
};
BUFFER_OF(FacesOfInstance, 8);

BUFFER_OF(Face, 8);

struct FaceTable {
    REF(FacesOfInstance) instances;  // in the order of the accelerator's instances
    REF(Face) faces;
};

FUNC uint face_of(FaceTable table, Hit hit) {
    return AT(table.instances, hit.instance_index).first + hit.primitive_index;
}

// Returns the point (1-u-v) v0 + u v1 + v v2 of a face, in world space, with the data for a ray to leave it.
FUNC SurfacePoint point_on_face(FaceTable table, uint face, vec2 uv) {
    Face which = AT(table.faces, face);
    FacesOfInstance instance = AT(table.instances, which.instance);
    PackedMesh mesh = instance.placed.mesh;
    return surface_point(placement_of(instance.placed.object_to_world),
                         vertices_of(mesh.positions, mesh.indices, which.primitive), uv);
}

// Returns whether a direction comes from the side on which the vertices turn counter-clockwise in object space.
FUNC bool meets_front(FaceTable table, uint face, vec3 direction) {
    Face which = AT(table.faces, face);
    FacesOfInstance instance = AT(table.instances, which.instance);
    PackedMesh mesh = instance.placed.mesh;
    TriangleVertices vertices = vertices_of(mesh.positions, mesh.indices, which.primitive);
    vec3 edge1 = vertices.b - vertices.a;
    vec3 edge2 = vertices.c - vertices.a;
    float scale = power_of_two_below(max(largest_entry(edge1), largest_entry(edge2)));
    vec3 normal = cross_precise(edge1 / scale, edge2 / scale);
    return dot(transform_vector(inverse_of(instance.placed.object_to_world), direction), normal) < 0.0f;
}
#endif
