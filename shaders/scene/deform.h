// SPDX-License-Identifier: MIT
// The arguments of the kernel that moves vertices. deformed() in twinray/scene.h says what it computes.
#ifndef TWINRAY_SCENE_DEFORM_H
#define TWINRAY_SCENE_DEFORM_H

struct DeformArgs {
    Floats positions;  // 3 floats a vertex
    Floats normals;    // 3; absent: none
    Floats tangents;   // 4; absent: none
    Floats moved_positions;
    Floats moved_normals;
    Floats moved_tangents;
    Floats target_positions;  // 3 floats a vertex, target after target
    Floats target_normals;    // likewise; absent: none
    Floats target_tangents;   // likewise
    Floats target_weights;
    Uints joints;          // `influences` a vertex
    Floats joint_weights;  // likewise
    Vec4s joint_rows;      // 3 a joint
    uint vertex_count;
    uint target_count;
    uint influences;  // 0: no skin
};
#endif
