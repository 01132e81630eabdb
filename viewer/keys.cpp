// SPDX-License-Identifier: MIT
#include "viewer/keys.h"

#include <algorithm>

namespace twinray::viewer {
namespace {

constexpr Key table[] = {
    {"Home", Action::frame_all, "show all of the scene"},
    {"F", Action::center_here, "turn about what the pointer is on (or double click)"},
    {"1", Action::front, "from the front"},
    {"3", Action::right, "from the right"},
    {"7", Action::top, "from above"},
    {"9", Action::isometric, "isometric"},
    {"5", Action::orthographic, "orthographic or perspective"},
    {"F1", Action::layer, "the picture, path traced", Layer::path},
    {"F2", Action::layer, "lit from the camera", Layer::eyelight},
    {"F3", Action::layer, "hit or miss", Layer::occlusion},
    {"F4", Action::layer, "barycentric u, v", Layer::uv},
    {"F5", Action::layer, "geometric normals", Layer::normal},
    {"F6", Action::layer, "a colour for each mesh", Layer::geometry},
    {"F7", Action::layer, "a colour for each triangle", Layer::primitive},
    {"F8", Action::layer, "distance", Layer::depth},
    {"F9", Action::layer, "steps a ray", Layer::steps},
    {"F10", Action::layer, "sunlight on each face", Layer::light},
    {"F11", Action::layer, "view factors from the picked face", Layer::factors},
    {"F12", Action::layer, "triangles that touch or cross others, by class", Layer::collisions},
    {"0", Action::layer, "distances on the plane through the centre", Layer::distance},
    {"L", Action::next_level, "the next level of the triangle test"},
    {"N", Action::next_camera, "the next camera of the file"},
    {"Tab", Action::flip_accelerators, "software or hardware"},
    {"W", Action::wipe, "both, with a wipe"},
    {"D", Action::difference, "where the two disagree"},
    {"]", Action::tree_deeper, "boxes of the tree, a level deeper"},
    {"[", Action::tree_higher, "a level higher, and off"},
    {"T", Action::tree_areas, "boxes in the colour of their share of the root's area (SAH)"},
    {"A", Action::all_features, "paths by kernels for every scene, or for what this one needs"},
    {"-", Action::darker, "half as bright; an hour earlier"},
    {"=", Action::brighter, "twice as bright; an hour later"},
    {"Space", Action::play, "play the animation"},
    {"C", Action::copy_camera, "the camera as options, to the terminal and the clipboard"},
    {"B", Action::copy_bookmark, "all that is shown as a command line, likewise"},
    {"R", Action::reload, "read the file again"},
    {"S", Action::screenshot, "write view.png"},
    {"E", Action::export_values, "write what is said of faces: view.csv and view.glb"},
    {"P", Action::panel, "panel of settings and figures"},
    {"H", Action::sheet, "this sheet"},
    {"Escape", Action::quit, "end"},
};

std::string on_if(bool is_on) { return is_on ? "on" : ""; }

}  // namespace

std::span<const Key> all_keys() { return table; }

const Key* find_key(std::string_view name) {
    const auto* found = std::ranges::find(table, name, &Key::name);
    return found == std::end(table) ? nullptr : found;
}

std::string state_of(const Key& key, const State& state) {
    switch (key.action) {
        case Action::layer: return on_if(state.layer == key.layer);
        case Action::flip_accelerators: return std::string(name_of(state.shown));
        case Action::next_level: return std::string(name_of(state.level));
        case Action::wipe: return on_if(state.shown == Shown::wipe);
        case Action::difference: return on_if(state.shown == Shown::difference);
        case Action::tree_areas: return on_if(state.has_area_colors);
        case Action::all_features: return on_if(state.has_all_features);
        case Action::orthographic: return on_if(state.orbit.is_orthographic);
        case Action::tree_deeper: return state.tree_depth ? "level " + std::to_string(*state.tree_depth) : "";
        default: return "";
    }
}

}  // namespace twinray::viewer
