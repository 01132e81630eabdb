// SPDX-License-Identifier: MIT
// A measure of trees that tells those of equal surface-area cost apart: how many boxes a ray enters in vain near where
// it ends (Aila, Karras, Laine, "On Quality Metrics of Bounding Volume Hierarchies", 2013; all costs are 1).
#pragma once

#include "swtlas/tree.h"

namespace twinray::reference {

// Over all boxes but the root's, the area of the triangles within that do not lie below it, over the area of all; 0
// where no box holds a part of a triangle that is not below it. Of a geometry of triangles, in any layout.
double end_point_overlap(const BuiltTree& tree);

}  // namespace twinray::reference
