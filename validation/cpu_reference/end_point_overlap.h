// SPDX-License-Identifier: MIT
// A measure that distinguishes trees of equal surface-area cost: how many boxes a ray enters in vain near where it ends
// (Aila, Karras, Laine, "On Quality Metrics of Bounding Volume Hierarchies", 2013; all costs are 1).
#pragma once

#include "swtlas/tree.h"

namespace twinray::reference {

// Returns, over all boxes but the root's, the area of the triangles within that do not lie below the box, over the area
// of all; 0 if no box holds a part of such a triangle. `tree` is that of a geometry of triangles, in any layout.
double end_point_overlap(const BuiltTree& tree);

}  // namespace twinray::reference
