// SPDX-License-Identifier: MIT
// The features of shaders/shared/features.h that a trace needs: a pure function of the data known when it is recorded.
#pragma once

#include <cstddef>

#include "engine/accel/trace_desc.h"

namespace twinray {

struct AccelTraits {
    bool is_software = true;
    Layout layout = Layout::compressed4;  // of software
    bool reorders = false;                // hardware: see FEATURE_REMAP
};

struct SceneTraits {
    bool has_boxes = false;
    bool has_filters = false;
    std::size_t instances = 1;
    uint common_mask = 0xff;      // bits that the masks of all instances share
    bool has_transforms = false;  // an instance may be, now or later, elsewhere than its geometry as it was built

    // Returns the traits of a scene that needs every feature that takes no trace program.
    static constexpr SceneTraits of_every_kind() { return {.instances = 2, .common_mask = 0, .has_transforms = true}; }
};

struct TraceTraits {
    uint mask = 0xff;
    bool culls = false;
    bool wants_hits = true;  // all of each, not only whether there is one

    static TraceTraits of(const TraceDesc& desc) {
        return {desc.mask, desc.cull != Cull::none, desc.query == Query::closest || !desc.occlusion_only};
    }
    // A kernel may ask for any mask, and cull.
    static constexpr TraceTraits of_every_kind() { return {.mask = 0, .culls = true}; }
};

constexpr uint feature_of_layout(Layout layout) {
    constexpr uint features[] = {FEATURE_COMPRESSED, FEATURE_BVH2, FEATURE_COMPRESSED8};
    return features[static_cast<std::size_t>(layout)];
}

constexpr uint features_of(const AccelTraits& accel, const SceneTraits& scene, const TraceTraits& trace) {
    const auto if_needed = [](bool is_needed, uint feature) { return is_needed ? feature : 0; };
    const uint of_both = if_needed(scene.has_boxes, FEATURE_BOXES) | if_needed(scene.has_filters, FEATURE_FILTERS) |
                         if_needed(trace.wants_hits, FEATURE_HITS);
    if (!accel.is_software) return of_both | if_needed(accel.reorders, FEATURE_REMAP);
    return of_both | feature_of_layout(accel.layout) | if_needed(scene.instances != 1, FEATURE_INSTANCES) |
           if_needed((trace.mask & scene.common_mask) == 0, FEATURE_MASKS) | if_needed(trace.culls, FEATURE_CULLING) |
           if_needed(scene.has_transforms, FEATURE_TRANSFORMS);
}

}  // namespace twinray
