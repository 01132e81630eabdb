// SPDX-License-Identifier: MIT
// Measures of built trees.
#include "engine/core/error.h"
#include "swtlas/built.h"
#include "swtlas_end_point_overlap.spv.h"

namespace twinray {

double SwBackend::end_point_overlap(AccelHandle handle) const {
    const auto& built = static_cast<const SwBuiltGeometry&>(built_geometry(handle));
    if (geometry(handle).kind == GEOMETRY_BOXES)
        fail("SwTlas: end_point_overlap: the geometry has boxes, not triangles");
    const uint count = built.layout.record_count ? built.layout.record_count : built.layout.triangle_count;
    if (count == 0) return 0;
    const Kernel<OverlapArgs> kernel(
        context(),
        {.name = "swtlas_end_point_overlap", .spirv = swtlas_end_point_overlap_spirv, .group_size = OVERLAP_GROUP});
    const std::size_t groups = (count + OVERLAP_GROUP - 1) / OVERLAP_GROUP;
    const Buffer sums(context(), {.name = "end-point overlap", .bytes = groups * sizeof(OverlapSum)});
    Commands commands(context(), "SwTlas end-point overlap");
    kernel.dispatch(commands, {{geometry_block(handle).address()}, sums.ref<OverlapSum>(), count, 0}, count);
    commands.submit();
    double overlap = 0, area = 0;
    for (const OverlapSum& sum : download<OverlapSum>(context(), sums, groups)) {
        overlap += double{sum.overlap};
        area += double{sum.area};
    }
    return area > 0 ? overlap / area : 0;
}

}  // namespace twinray
