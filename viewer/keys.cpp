// SPDX-License-Identifier: MIT
#include "viewer/keys.h"

#include <algorithm>

namespace twinray::viewer {
namespace {

constexpr Key table[] = {
    {"Home", Action::frame_all, "show the whole scene"},
    {"F", Action::center_here, "set the orbit centre to the point under the pointer (or double-click)"},
    {.name = "1", .action = Action::side, .what = "view from the front", .side = Side::front},
    {.name = "3", .action = Action::side, .what = "view from the right", .side = Side::right},
    {.name = "7", .action = Action::side, .what = "from above", .side = Side::top},
    {.name = "9", .action = Action::side, .what = "isometric", .side = Side::isometric},
    {"5", Action::orthographic, "orthographic or perspective projection"},
    {"F1", Action::layer, "path-traced picture", Layer::path},
    {"F2", Action::layer, "base colours lit from the camera", Layer::eyelight},
    {"F3", Action::layer, "hit or miss", Layer::occlusion},
    {"F4", Action::layer, "barycentric u, v", Layer::uv},
    {"F5", Action::layer, "geometric normals", Layer::normal},
    {"F6", Action::layer, "one colour per mesh", Layer::geometry},
    {"F7", Action::layer, "one colour per triangle", Layer::primitive},
    {"F8", Action::layer, "distance", Layer::depth},
    {"F9", Action::layer, "steps a ray", Layer::steps},
    {"F10", Action::layer, "sunlight on each face", Layer::light},
    {"F11", Action::layer, "view factors from the picked face", Layer::factors},
    {"F12", Action::layer, "triangles that touch or cross others, by class", Layer::collisions},
    {"0", Action::layer, "distances on a plane through the orbit centre", Layer::distance},
    {"L", Action::next_level, "next level of the triangle test"},
    {"N", Action::next_camera, "next camera of the file"},
    {"Tab", Action::flip_accelerators, "software or hardware"},
    {"W", Action::wipe, "both accelerators, with a movable divider"},
    {"D", Action::difference, "pixels where the two disagree"},
    {"]", Action::tree_deeper, "boxes of the tree, one level deeper"},
    {"[", Action::tree_higher, "one level higher, then off"},
    {"T", Action::tree_areas, "colour the boxes by their share of the root's area (SAH)"},
    {"A", Action::all_features, "path-trace with kernels for every scene, or for this scene only"},
    {"-", Action::darker, "half the exposure; one hour earlier"},
    {"=", Action::brighter, "twice the exposure; one hour later"},
    {"Space", Action::play, "play the animation"},
    {"C", Action::copy_camera, "print the camera as options, and copy it to the clipboard"},
    {"B", Action::copy_bookmark, "print the display as a command line, and copy it to the clipboard"},
    {"R", Action::reload, "reload the file"},
    {"S", Action::screenshot, "write view.png"},
    {"E", Action::export_values, "write the values of faces to view.csv and view.glb"},
    {"P", Action::panel, "show the panel of settings and statistics"},
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

bool is_flight(std::string_view name) {
    return name.size() == 1 && std::string_view("WASDQE").find(name) != std::string_view::npos;
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
