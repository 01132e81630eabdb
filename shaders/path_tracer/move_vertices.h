// SPDX-License-Identifier: MIT
// The arguments of the kernel that writes moved vertices into a mesh's records. Needs scene.h.
#ifndef TWINRAY_PATH_TRACER_MOVE_VERTICES_H
#define TWINRAY_PATH_TRACER_MOVE_VERTICES_H

struct MoveVerticesArgs
{
    REF(SurfaceVertex) vertices;
    Floats positions; // 3 floats a vertex
    Floats normals;   // 3; absent: the mesh has none
    Floats tangents;  // 4; absent: the mesh has none
    uint count;
};
#endif
