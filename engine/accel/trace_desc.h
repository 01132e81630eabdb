// TraceArgs, the features and the levels for C++; the features that a trace needs; whether an accelerator can trace at
// a level. Pure functions of the data known when a trace is recorded.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <twinray/trace.h>

#include "engine/core/ray.h"

namespace twinray {
#include "twinray/glsl/cpp_begin.h"
#include "shaders/shared/trace.h"
#include "twinray/glsl/cpp_end.h"

static_assert(sizeof(TraceArgs) == 64);

// Returns whether trees consist of records (shaders/shared/compressed.h).
constexpr bool has_records(Layout layout) { return layout != Layout::bvh2; }
// Returns the most children that a node has.
constexpr uint width_of(Layout layout) { return layout == Layout::bvh2 ? 2 : layout == Layout::compressed8 ? 8 : 4; }

constexpr uint flags_of(Cull cull) { return cull == Cull::none ? 0 : cull == Cull::back ? CULL_BACK : CULL_FRONT; }

// The features of shaders/shared/features.h that a trace needs follow from these traits.
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

// Features of SwTlas's kernel that a scene may not need, in the order in which measurements add them.
struct FeatureAddition {
    const char* name;
    uint features;
};
// Ordered from the most often needed to the rarest.
inline constexpr std::array feature_additions = {
    FeatureAddition{"+ hits", FEATURE_HITS},
    FeatureAddition{"+ transforms", FEATURE_TRANSFORMS},
    FeatureAddition{"+ instances", FEATURE_INSTANCES},
    FeatureAddition{"+ masks", FEATURE_MASKS},
    FeatureAddition{"+ culling", FEATURE_CULLING},
    FeatureAddition{"+ filters", FEATURE_FILTERS},
    FeatureAddition{"+ boxes", FEATURE_BOXES},
    FeatureAddition{"+ other layouts", FEATURE_BVH2 | FEATURE_COMPRESSED | FEATURE_COMPRESSED8}};

// Throws Error, naming the accelerator and the action, if the device does not support the level or `made_for` is less:
// the data that the level reads is then missing. `accel` is an AbstractAccel or an AccelBackend.
void check_level(const std::string& name, const char* doing, const Capability& can, Level level, Level made_for);
void check_level(const auto& accel, const char* doing, Level level) {
    check_level(accel.name(), doing, accel.capability(feature_of(level)), level, accel.options().level);
}

}  // namespace twinray
