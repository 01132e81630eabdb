// SPDX-License-Identifier: MIT
// Traversal of a SwScene.
#ifndef TWINRAY_SHARED_TRAVERSE_H
#define TWINRAY_SHARED_TRAVERSE_H
#include "shaders/shared/traverse_bvh2.h"
#include "shaders/shared/traverse_records.h"

// Traces a ray. The closest hit is the first by comes_before, whatever the layout and the order of traversal; with
// QUERY_ANY it is the first one found.
FUNC Hit traverse(SwScene scene, Ray ray, TraceOptions options)
{
    bool may_be_bvh2 = (options.features & FEATURE_BVH2) != 0u;
    bool may_have_records = (options.features & (FEATURE_COMPRESSED | FEATURE_BVH4)) != 0u;
    if (may_have_records && (!may_be_bvh2 || uint64_t(scene.records) != 0ul)) return traverse_records(scene, ray, options);
    return traverse_bvh2(scene, ray, options);
}
#endif
