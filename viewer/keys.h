// SPDX-License-Identifier: MIT
// The function of each key: one table, which the program and its sheet of keys read.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "viewer/state.h"

namespace twinray::viewer {

enum class Action : std::uint8_t {
    frame_all,
    center_here,
    side,
    orthographic,
    layer,
    flip_accelerators,
    next_level,
    next_camera,
    wipe,
    difference,
    tree_deeper,
    tree_higher,
    tree_areas,
    all_features,
    darker,
    brighter,
    play,
    copy_camera,
    copy_bookmark,
    reload,
    panel,
    sheet,
    screenshot,
    export_values,
    quit,
};

struct Key {
    std::string_view name;  // "F2", "Tab", "[": as events have it
    Action action;
    std::string_view what;          // for the sheet
    Layer layer = Layer::eyelight;  // of Action::layer
    Side side = Side::front;        // of Action::side
};
std::span<const Key> all_keys();
// Returns null if the key does nothing.
const Key* find_key(std::string_view name);

// Returns whether the key flies while the right button is down.
bool is_flight(std::string_view name);

// Returns the state that a key changes, for the sheet: "on", "sw", ...; empty if there is none.
std::string state_of(const Key& key, const State& state);

}  // namespace twinray::viewer
