// SPDX-License-Identifier: MIT
#include "bench/embree_backend.h"

namespace twinray::bench {

LineUp embree_line_up(const std::function<bool(const std::string&)>&) { return {}; }

std::string why_no_embree() { return "this twinray was built without Embree 3 (Debian 12: libembree-dev)"; }

}  // namespace twinray::bench
