// SPDX-License-Identifier: MIT
// What an accelerator can do on a device.
#pragma once

#include <array>
#include <string>

#include "engine/accel/trace_desc.h"
#include "engine/core/device_choice.h"

namespace twinray {

enum class Feature : std::uint8_t {
    closest_hit,
    any_hit,
    deterministic_ties,  // of hits at the same t the lowest (instance, primitive) counts
    masks,
    culling,
    boxes,           // geometry of boxes with the user's intersection
    filters,         // any-hit filters
    kernel_queries,  // twinray/query.glsl inside kernels
    level_fast,
    level_watertight,
    level_refined,
    level_certified,
    refit_instances,
    refit_vertices,
    compaction,
    save_and_load,
};
constexpr std::size_t feature_count = 16;

enum class Support : std::uint8_t {
    unsupported,
    emulated,  // works, but by other means than the accelerator's own
    native,
};

struct Capability {
    Feature feature;
    Support support;
    std::string note;  // how, or why not; may be empty
};

const char* name_of(Feature feature);
const char* name_of(Support support);
Feature feature_of(Level level);

}  // namespace twinray
