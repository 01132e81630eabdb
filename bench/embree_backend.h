// SPDX-License-Identifier: MIT
// Embree 3 as backends that the bench measures.
#pragma once

#include <functional>
#include <string>

#include "bench/backend.h"

namespace twinray::bench {

// Returns Embree 3 on count_cpu_threads() threads, in the variants whose name is_wanted; nothing if this program was
// built without it.
LineUp embree_line_up(const std::function<bool(const std::string&)>& is_wanted);
// Returns "" if this program was built with Embree.
std::string why_no_embree();

}  // namespace twinray::bench
