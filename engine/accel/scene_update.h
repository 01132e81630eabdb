// SPDX-License-Identifier: MIT
// Whether a top level is built anew or refitted.
#pragma once

#include <cstddef>

namespace twinray {

struct SceneChange {
    bool is_built = false;          // there is a top level
    bool was_moved = false;         // before: what never moved is built so that it cannot be refitted
    bool has_structure = false;     // something was pushed, erased or replaced
    bool has_new_geometry = false;  // built anew: its instances may have been inactive, which a refit cannot change
    bool has_degraded = false;      // refits have made it bad
    std::size_t built_count = 0;    // instances of the top level as it was built
    std::size_t count = 0;          // and now: Vulkan forbids an update to change their number
};

constexpr bool must_build(const SceneChange& change) {
    return !change.is_built || !change.was_moved || change.has_structure || change.has_new_geometry ||
           change.has_degraded || change.built_count != change.count;
}

}  // namespace twinray
