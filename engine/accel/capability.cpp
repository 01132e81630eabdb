// SPDX-License-Identifier: MIT
#include <twinray/trace.h>

#include "engine/accel/check_level.h"
#include "engine/core/error.h"

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

void check_level(const std::string& name, const char* doing, const Capability& can, Level level, Level made_for) {
    if (can.support == Support::unsupported)
        fail(name, ": ", doing, ": ", name_of(can.feature), " is unsupported: ", can.note);
    if (level >= Level::refined && level > made_for)
        fail(name, ": ", doing, ": ", name_of(feature_of(level)), " is more than the accelerator was made for, ",
             name_of(feature_of(made_for)), "; see AccelOptions");
}

}  // namespace twinray
