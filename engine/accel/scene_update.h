// SPDX-License-Identifier: MIT
// Decides whether a top level is rebuilt or refitted.
#pragma once

#include <cstddef>

namespace twinray {

struct SceneChange {
    bool is_built = false;          // there is a top level
    bool was_moved = false;         // before: top levels that never moved are built so that they cannot be refitted
    bool has_structure = false;     // something was pushed, erased or replaced
    bool has_new_geometry = false;  // rebuilt: its instances may have been inactive, which a refit cannot change
    bool has_degraded = false;      // refits have made it bad
    std::size_t built_count = 0;    // instances of the top level as it was built
    std::size_t count = 0;          // the present number: Vulkan forbids an update to change it
};

constexpr bool must_build(const SceneChange& change) {
    return !change.is_built || !change.was_moved || change.has_structure || change.has_new_geometry ||
           change.has_degraded || change.built_count != change.count;
}

}  // namespace twinray
