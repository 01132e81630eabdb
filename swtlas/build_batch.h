// SPDX-License-Identifier: MIT
// What the stages of one build share: where in the scratch each array lies.
#pragma once

#include "swtlas/build.h"

namespace twinray {

// The addresses of a batch's scratch regions.
struct Builder::Batch {
    const Buffer& scratch;
    Ref<BuildTree> trees;
    Ref<BuildBlock> blocks;
    Ref<LeafBox> boxes;
    Ref<CentroidBounds> centroids;
    Uints codes, fine_codes, tree_of, meeting, counters;
    Uints crowded;
    Ref<Crowding> crowding;
    RadixSort::Pairs pairs, spare;
    uint block_count;

    const RadixSort::Pairs& other(const RadixSort::Pairs& of) const {
        return of.keys.address == pairs.keys.address ? spare : pairs;
    }
};

inline Buffer build_scratch(Context& context, const BuildPlan& plan) {
    return Buffer(context,
                  {.name = "swtlas build scratch", .bytes = plan.scratch.bytes, .alignment = cache_line_bytes});
}

}  // namespace twinray
