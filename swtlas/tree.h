// SPDX-License-Identifier: MIT
// Copies of the structures of SwTlas, for checks and tools.
#pragma once

#include <vector>

#include <twinray/tlas.h>

#include "swtlas/structures.h"

namespace twinray {

struct BuiltTree {
    Bvh bvh;
    std::vector<BvhNode> nodes;             // of layout bvh2
    std::vector<BvhTriangle> triangles;     // of a geometry in layout bvh2
    std::vector<CompressedRecord> records;  // of all other layouts
    SharedArray<vec3> vertices;             // of leaves of two triangles
};
// Downloads it. Throws Error on a dead or unsynced handle.
BuiltTree download_geometry(const SwTlas& accel, AccelHandle handle);
BuiltTree download_scene(const SwTlas& accel);

}  // namespace twinray
