// SPDX-License-Identifier: MIT
// Copies of what SwTlas has built, and measures of it, for checks and tools.
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
};
// Downloaded. Throws Error on a dead or unsynced handle.
BuiltTree download_geometry(const SwTlas& accel, AccelHandle handle);
BuiltTree download_scene(const SwTlas& accel);

// The end-point overlap of the geometry's tree, see end_point_overlap.h: 0 where no box holds a part of a triangle
// that is not below it. Measured by the GPU in float32, right to 1e-4 of itself and 1e-5; waits for it. It takes
// about as long as tracing a ray for each triangle. Throws Error on a dead or unsynced handle and on a geometry of
// boxes.
double end_point_overlap(const SwTlas& accel, AccelHandle handle);

}  // namespace twinray
