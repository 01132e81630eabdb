// SPDX-License-Identifier: MIT
#include "viewer/state.h"

#include <sstream>

namespace twinray::viewer {

std::string_view name_of(Layer layer) {
    constexpr std::string_view names[] = {"path",     "eyelight",  "occlusion", "uv",       "normal",
                                          "geometry", "primitive", "depth",     "distance", "steps",
                                          "light",    "factors",   "collisions"};
    return names[static_cast<std::size_t>(layer)];
}

std::string_view name_of(Shown shown) {
    constexpr std::string_view names[] = {"sw", "hw", "wipe", "difference"};
    return names[static_cast<std::size_t>(shown)];
}

std::string options_of(const State& state, const dvec3& origin) {
    const State usual;
    std::ostringstream out;
    out << options_of(state.orbit, origin) << " --layer " << name_of(state.layer);
    if (state.shown != usual.shown) out << " --show " << name_of(state.shown);
    if (state.shown == Shown::wipe) out << " --wipe " << state.wipe;
    if (state.level != usual.level) out << " --level " << name_of(state.level);
    if (state.has_area_colors) out << " --tree-areas";
    if (state.tree_depth) out << " --tree-depth " << *state.tree_depth;
    if (state.width != usual.width || state.height != usual.height)
        out << " --size " << state.width << ' ' << state.height;
    if (state.picked && state.picked_from == state.orbit)
        out << " --pick " << state.picked->x << ' ' << state.picked->y;
    if (state.seconds != usual.seconds) out << " --time " << state.seconds;
    if (state.layer == Layer::light) out << " --hour " << state.hour;
    if (state.has_all_features) out << " --all-features";
    if (state.exposure != usual.exposure) out << " --exposure " << state.exposure;
    return out.str();
}

}  // namespace twinray::viewer
