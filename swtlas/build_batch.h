// SPDX-License-Identifier: MIT
// The common part of the stages of one build: the place of each array in the scratch.
#pragma once

#include "swtlas/build.h"

namespace twinray {

// A batch in its scratch.
struct Builder::Batch {
    const Buffer& scratch;
    BuildArgs args;
    Uints counters;
    RadixSort::Pairs pairs, spare;

    const RadixSort::Pairs& other(const RadixSort::Pairs& of) const {
        return of.keys.address == pairs.keys.address ? spare : pairs;
    }
    // Has the leaves in order, and the lists of clusters in the half of the ping-pong that the sort has left.
    BuildArgs sorted(const RadixSort::Pairs& order) const {
        BuildArgs in_order = args;
        in_order.codes = order.keys;
        in_order.order = order.values;
        in_order.tops = other(order).keys;
        in_order.last_leaves = other(order).values;
        return in_order;
    }
};

inline Buffer build_scratch(Context& context, const BuildPlan& plan) {
    return Buffer(context,
                  {.name = "swtlas build scratch", .bytes = plan.scratch.bytes, .alignment = cache_line_bytes});
}

}  // namespace twinray
