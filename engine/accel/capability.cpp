// SPDX-License-Identifier: MIT
#include <twinray/trace.h>

namespace twinray {

const char* name_of(Feature feature) {
    constexpr std::array<const char*, feature_count> names = {
        "closest hit",   "any hit",         "deterministic ties", "masks",        "culling",
        "boxes",         "filters",         "queries in kernels", "level fast",   "level watertight",
        "level refined", "level certified", "instance refit",     "vertex refit", "compaction",
        "save and load"};
    return names.at(static_cast<std::size_t>(feature));
}

const char* name_of(Support support) {
    return support == Support::native ? "native" : support == Support::emulated ? "emulated" : "unsupported";
}

Feature feature_of(Level level) {
    return static_cast<Feature>(static_cast<int>(Feature::level_fast) + static_cast<int>(level));
}

}  // namespace twinray
